// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/map_store.hpp"

#include <algorithm>
#include <span>

#include "picolo/core/bytes.hpp"
#include "picolo/core/crc.hpp"

namespace picolo::inline v0 {
namespace {

using Piece = std::array<std::uint8_t, MapStore::kPieceSize>;
static_assert(kMapHeaderSize % 16 == 0 && MapStore::kPieceSize % 16 == 0,
              "granules are at most 16");

std::size_t half_of(const ByteStoreGeometry& geometry, std::size_t address) {
  if (geometry.sector == 0 || address >= geometry.size) { return 0; }
  return (geometry.size - address) / geometry.sector / 2 * geometry.sector;
}

}  // namespace

MapStore::MapStore(ByteStore& medium, const MapStoreConfig& config)
    : medium_(medium),
      address_(config.address),
      slot_size_(config.slot_size == 0 ? half_of(medium.geometry(), config.address)
                                       : config.slot_size) {}

std::size_t MapStore::newest() const {
  const bool first = is_ok(slots_[0].status);
  const bool second = is_ok(slots_[1].status);
  if (first && second) {
    return wrapped_difference(slots_[1].header.sequence, slots_[0].header.sequence) > 0 ? 1 : 0;
  }
  return first ? 0 : 1;  // an empty store begins with slot 0
}

Status MapStore::survey() {
  if (busy()) { return Status::full; }
  const ByteStoreGeometry geometry = medium_.geometry();
  if (geometry.sector == 0 || slot_size_ < kMapHeaderSize + kPieceSize ||
      slot_size_ % geometry.sector != 0 || address_ % geometry.sector != 0 ||
      address_ + 2 * slot_size_ > geometry.size) {
    return Status::invalid_argument;
  }
  for (std::size_t slot = 0; slot < 2; ++slot) {
    std::array<std::uint8_t, kMapHeaderSize> bytes{};
    const Status read = medium_.read(slot_address(slot), bytes);
    if (!is_ok(read)) { return read; }
    slots_[slot].status = decode_map_header(bytes, slots_[slot].header);
    if (is_ok(slots_[slot].status) &&
        slots_[slot].header.payload_bytes > slot_size_ - kMapHeaderSize) {
      slots_[slot].status = Status::corrupt;
    }
  }
  const bool newer =
      slots_[0].status == Status::unsupported || slots_[1].status == Status::unsupported;
  return newer ? Status::unsupported : Status::ok;
}

Status MapStore::abandon(Status status) {
  phase_ = Phase::idle;
  return status;
}

Status MapStore::begin_load(RollingMapCore& map) {
  const Status status = survey();
  if (!is_ok(status)) { return status; }
  if (!is_ok(slots_[newest()].status)) {
    const bool blank =
        slots_[0].status == Status::not_ready && slots_[1].status == Status::not_ready;
    return blank ? Status::not_ready : Status::corrupt;
  }
  target_ = &map;
  second_try_ = false;
  return start_checking(newest());
}

Status MapStore::start_checking(std::size_t slot) {
  if (!MapDecoder::fits(slots_[slot].header, *target_)) { return Status::invalid_argument; }
  slot_ = slot;
  header_ = slots_[slot].header;
  at_ = 0;
  crc_ = 0;
  phase_ = Phase::verify;
  return Status::ok;
}

Status MapStore::begin_save(const RollingMapCore& map) {
  const Status status = survey();
  if (!is_ok(status)) { return status; }
  const std::size_t newest_slot = newest();
  target_ = nullptr;
  header_ = {};
  header_.sequence =
      is_ok(slots_[newest_slot].status) ? slots_[newest_slot].header.sequence + 1 : 1;
  header_.window = map.window();
  header_.occupied_from = map.config().occupied_from;
  slot_ = 1 - newest_slot;
  encoder_.begin(map);
  at_ = 0;
  crc_ = 0;
  erased_ = 0;
  phase_ = Phase::write;
  return Status::ok;
}

Status MapStore::step(std::size_t max_pieces) {
  if (phase_ == Phase::idle) { return Status::ok; }
  if (needs_erased()) {
    const Status status = medium_.erase(slot_address(slot_) + erased_);
    if (status == Status::not_ready) { return status; }
    if (!is_ok(status)) { return abandon(status); }
    erased_ += medium_.geometry().sector;
    return Status::not_ready;
  }
  // Bytes tell little of the work: a few may stand for thousands of cells.
  const std::size_t last_cell = cells_covered() + kCellsPerStep;
  for (std::size_t k = 0; k < max_pieces && !needs_erased() && cells_covered() < last_cell; ++k) {
    Status status = Status::io_error;
    switch (phase_) {
      case Phase::write: status = write_piece(); break;
      case Phase::verify: status = verify_piece(); break;
      case Phase::commit: status = commit(); break;
      case Phase::load: status = load_piece(); break;
      case Phase::idle: break;
    }
    if (status != Status::not_ready) { return abandon(status); }
  }
  return Status::not_ready;
}

std::size_t MapStore::cells_covered() const {
  if (phase_ == Phase::write) { return encoder_.cells_covered(); }
  return phase_ == Phase::load ? decoder_.cells_covered() : 0;
}

// Just what is written, sector by sector, however large the slot; the header's sector first: from
// then on the slot is no map.
bool MapStore::needs_erased() const {
  return phase_ == Phase::write && erased_ < slot_size_ &&
         kMapHeaderSize + at_ + kPieceSize > erased_;
}

Status MapStore::write_piece() {
  if (encoder_.window_moved()) { return Status::out_of_range; }
  Piece piece{};
  piece.fill(0xFF);
  const MapEncoder before = encoder_;
  const std::size_t size = encoder_.encode(piece);
  if (size == 0) {
    header_.payload_bytes = static_cast<std::uint32_t>(at_);
    header_.payload_crc = crc_;
    at_ = 0;
    crc_ = 0;
    phase_ = Phase::verify;
    return Status::not_ready;
  }
  if (kMapHeaderSize + at_ + kPieceSize > slot_size_) { return Status::full; }
  const Status status = medium_.program(slot_address(slot_) + kMapHeaderSize + at_, piece);
  if (!is_ok(status)) {
    encoder_ = before;  // `not_ready`: the same piece again
    return status;
  }
  crc_ = crc32(std::span{piece}.first(size), crc_);
  at_ += size;
  return Status::not_ready;
}

Status MapStore::verify_piece() {
  const std::size_t size = std::min<std::size_t>(kPieceSize, header_.payload_bytes - at_);
  if (size == 0) {
    if (target_ != nullptr) { return after_check(); }
    if (crc_ != header_.payload_crc) { return Status::corrupt; }
    phase_ = Phase::commit;
    return Status::not_ready;
  }
  Piece piece{};
  const auto bytes = std::span{piece}.first(size);
  const Status status = medium_.read(slot_address(slot_) + kMapHeaderSize + at_, bytes);
  if (!is_ok(status)) { return status; }
  crc_ = crc32(bytes, crc_);
  at_ += size;
  return Status::not_ready;
}

Status MapStore::commit() {
  std::array<std::uint8_t, kMapHeaderSize> bytes{};
  encode_map_header(header_, bytes);
  Status status = medium_.program(slot_address(slot_), bytes);
  if (!is_ok(status)) { return status; }
  std::array<std::uint8_t, kMapHeaderSize> back{};
  status = medium_.read(slot_address(slot_), back);
  if (!is_ok(status)) { return status; }
  return back == bytes ? Status::ok : Status::corrupt;
}

Status MapStore::after_check() {
  if (crc_ == header_.payload_crc) {
    at_ = 0;
    phase_ = Phase::load;
    return is_ok(decoder_.begin(header_, *target_)) ? Status::not_ready : Status::invalid_argument;
  }
  // Damaged since it was written: the other slot holds the map before.
  const std::size_t other = 1 - slot_;
  if (second_try_ || !is_ok(slots_[other].status)) { return Status::corrupt; }
  second_try_ = true;
  const Status status = start_checking(other);
  return is_ok(status) ? Status::not_ready : status;
}

Status MapStore::load_piece() {
  const std::size_t size = std::min<std::size_t>(kPieceSize, header_.payload_bytes - at_);
  if (size == 0) { return decoder_.complete() ? Status::ok : Status::corrupt; }
  Piece piece{};
  const auto bytes = std::span{piece}.first(size);
  Status status = medium_.read(slot_address(slot_) + kMapHeaderSize + at_, bytes);
  if (!is_ok(status)) { return status; }
  at_ += size;
  status = decoder_.decode(bytes);
  return is_ok(status) ? Status::not_ready : status;
}

}  // namespace picolo::inline v0
