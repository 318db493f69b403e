// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "counters.hpp"

namespace picolo::inline v0::devices {

std::uint64_t value_of(const Counters& counters, std::string_view name) {
  for (const Counter& counter : counters) {
    if (counter.name == name) { return counter.value; }
  }
  return 0;
}

Counters to_list(const SerialCounters& c) {
  return {{"bytes", c.bytes},
          {"frames", c.frames},
          {"samples", c.samples},
          {"bad_checksums", c.bad_checksums},
          {"implausible", c.implausible},
          {"skipped_bytes", c.skipped_bytes},
          {"saturated", c.saturated},
          {"missed", c.missed},
          {"clock_restarts", c.clock_restarts},
          {"restarts", c.restarts}};
}

Counters to_list(const Ld06Counters& c) {
  return {{"bytes", c.bytes},
          {"frames", c.packets},
          {"bad_checksums", c.bad_checksums},
          {"implausible", c.implausible},
          {"skipped_bytes", c.skipped_bytes},
          {"clock_restarts", c.clock_restarts}};
}

Counters to_list(const WitMotionCounters& c) {
  return {{"bytes", c.bytes},
          {"frames", c.frames},
          {"samples", c.samples},
          {"bad_checksums", c.bad_checksums},
          {"skipped_bytes", c.skipped_bytes},
          {"incomplete", c.incomplete},
          {"saturated", c.saturated}};
}

Counters to_list(const CanopenWheelsCounters& c) {
  return {{"process_data", c.process_data},
          {"samples", c.samples},
          {"replaced", c.replaced},
          {"foreign", c.foreign},
          {"short_frames", c.short_frames},
          {"bad_states", c.bad_states},
          {"unpaired", c.unpaired},
          {"out_of_range", c.out_of_range},
          {"jumps", c.jumps},
          {"syncs_seen", c.syncs_seen},
          {"syncs_sent", c.syncs_sent},
          {"syncs_skipped", c.syncs_skipped},
          {"sync_conflicts", c.sync_conflicts},
          {"tx_refused", c.tx_refused},
          {"setup_failures", c.setup_failures}};
}

Counters to_list(const CanWheelsCounters& c) {
  return {{"frames", c.frames},
          {"samples", c.samples},
          {"replaced", c.replaced},
          {"foreign", c.foreign},
          {"short_frames", c.short_frames},
          {"damaged", c.damaged},
          {"missed", c.missed},
          {"unpaired", c.unpaired},
          {"out_of_range", c.out_of_range},
          {"jumps", c.jumps},
          {"losses", c.losses},
          {"requests", c.requests},
          {"tx_refused", c.tx_refused}};
}

}  // namespace picolo::inline v0::devices
