// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/calibration_store.hpp"

#include <span>

#include "picolo/core/bytes.hpp"

namespace picolo::inline v0 {

std::size_t CalibrationStore::slot_address(std::size_t slot) const {
  return address_ + slot * medium_.geometry().sector;
}

Status CalibrationStore::survey(Survey& result) {
  const ByteStoreGeometry geometry = medium_.geometry();
  if (geometry.sector < kCalibrationRecordSize || address_ % geometry.sector != 0 ||
      address_ + 2 * geometry.sector > geometry.size ||
      kCalibrationRecordSize % geometry.granule != 0) {
    return Status::invalid_argument;
  }
  for (std::size_t slot = 0; slot < 2; ++slot) {
    std::array<std::uint8_t, kCalibrationRecordSize> bytes{};
    const Status read = medium_.read(slot_address(slot), bytes);
    if (!is_ok(read)) { return read; }
    DecodedRecord decoded;
    const Status status = decode_record(bytes, decoded);
    result.blank = result.blank && status == Status::not_ready;
    result.newer_version = result.newer_version || status == Status::unsupported;
    if (!is_ok(status)) { continue; }
    if (!result.found || wrapped_difference(decoded.sequence, result.sequence) > 0) {
      result.record = decoded.record;
      result.sequence = decoded.sequence;
      result.newest = slot;
    }
    result.found = true;
  }
  return Status::ok;
}

Status CalibrationStore::load(CalibrationRecord& record) {
  record = CalibrationRecord{};
  Survey found;
  const Status status = survey(found);
  if (!is_ok(status)) { return status; }
  if (found.newer_version) { return Status::unsupported; }
  if (!found.found) { return found.blank ? Status::not_ready : Status::corrupt; }
  record = found.record;
  return Status::ok;
}

Status CalibrationStore::begin_save(const CalibrationRecord& record) {
  if (saving()) { return Status::full; }
  Survey found;
  const Status status = survey(found);
  if (!is_ok(status)) { return status; }
  if (found.newer_version) { return Status::unsupported; }
  slot_ = 1 - found.newest;
  encode_record(record, found.sequence + 1, bytes_);
  programmed_ = 0;
  phase_ = Phase::erase;
  return Status::ok;
}

Status CalibrationStore::abandon(Status status) {
  phase_ = Phase::idle;
  return status;
}

Status CalibrationStore::step(std::size_t max_granules) {
  if (phase_ == Phase::idle) { return Status::ok; }
  if (phase_ == Phase::erase) {
    const Status status = medium_.erase(slot_address(slot_));
    if (status == Status::not_ready) { return status; }
    if (!is_ok(status)) { return abandon(status); }
    phase_ = Phase::program;
    return Status::not_ready;
  }
  const std::size_t granule = medium_.geometry().granule;
  for (std::size_t k = 0; k < max_granules && programmed_ < bytes_.size(); ++k) {
    const Status status = medium_.program(slot_address(slot_) + programmed_,
                                          std::span{bytes_}.subspan(programmed_, granule));
    if (status == Status::not_ready) { return status; }
    if (!is_ok(status)) { return abandon(status); }
    programmed_ += granule;
  }
  if (programmed_ < bytes_.size()) { return Status::not_ready; }
  std::array<std::uint8_t, kCalibrationRecordSize> back{};
  const Status status = medium_.read(slot_address(slot_), back);
  if (!is_ok(status)) { return abandon(status); }
  return abandon(back == bytes_ ? Status::ok : Status::corrupt);
}

}  // namespace picolo::inline v0
