#include "appliance/depth/depth_board.h"

#include <algorithm>
#include <cassert>

#include "appliance/words/phrase.h"

namespace appliance {
namespace {

// A place names a pair and the slot that holds it.
constexpr int kSlotBits = 16;
constexpr std::uint64_t place(std::uint64_t number, std::uint32_t slot) {
  return number << kSlotBits | slot;
}
constexpr std::uint64_t numberAt(std::uint64_t place) {
  return place >> kSlotBits;
}
constexpr std::uint32_t slotAt(std::uint64_t place) {
  return static_cast<std::uint32_t>(place & ((1U << kSlotBits) - 1));
}

/// One writer: no read-modify-write.
void add(std::atomic<std::uint64_t>& counter, std::uint64_t more) {
  counter.store(counter.load(std::memory_order_relaxed) + more, std::memory_order_relaxed);
}

}  // namespace

std::expected<DepthReader*, std::string> DepthBoard::openReader(std::string name,
                                                                std::uint32_t pins) {
  const std::size_t count = reader_count_.load(std::memory_order_relaxed);
  if (count == kMostReaders) {
    return std::unexpected(withId(phrase<Word::kDepthReaders>(name, kMostReaders)));
  }
  if (pins > kMostPins - budgeted_pins_) {
    return std::unexpected(
        withId(phrase<Word::kDepthPins>(name, pins, kMostPins - budgeted_pins_)));
  }
  budgeted_pins_ += pins;
  readers_[count] = std::make_unique<DepthReader>(*this, std::move(name), pins);
  reader_count_.store(count + 1, std::memory_order_release);
  return readers_[count].get();
}

void DepthBoard::publish(const hal::DepthFrame& frame) {
  const auto slot = pool_.tryAcquire();
  assert(slot.has_value());  // kept pairs, this one and all budgets fit
  if (!slot) return;
  const std::uint64_t number = newest() + 1;
  Slot& filled = slots_[*slot];
  filled.picture = {.number = number,
                    .sensor_number = frame.number,
                    .width_px = frame.width_px,
                    .height_px = frame.height_px,
                    .lens = frame.lens,
                    .colour_lens = frame.colour_lens,
                    .exposure = frame.exposure,
                    .colour_exposure = frame.colour_exposure,
                    .frame_ready = frame.frame_ready};
  filled.depth_mm.assign(frame.depth_mm.begin(), frame.depth_mm.end());
  filled.colour_rgb.assign(frame.colour_rgb.begin(), frame.colour_rgb.end());

  std::atomic<std::uint64_t>& where = places_[number % kKept];
  const std::uint64_t overwritten = where.load(std::memory_order_relaxed);
  if (numberAt(overwritten) != 0) pool_.retire(slotAt(overwritten));
  pool_.publish(*slot, number);
  where.store(place(number, *slot), std::memory_order_release);
  newest_.store(number, std::memory_order_release);
  for (std::size_t i = 0; i < reader_count_.load(std::memory_order_acquire); ++i)
    readers_[i]->bell_.ring();
}

std::vector<DepthReaderStatus> DepthBoard::readers() const {
  std::vector<DepthReaderStatus> all;
  for (std::size_t i = 0; i < reader_count_.load(std::memory_order_acquire); ++i)
    all.push_back(readers_[i]->status());
  return all;
}

std::uint64_t DepthBoard::oldest() const noexcept {
  const std::uint64_t last = newest();
  return last > kKept ? last - kKept + 1 : 1;
}

std::optional<DepthBoard::Found> DepthBoard::tryFind(std::uint64_t number) noexcept {
  const std::uint64_t found = places_[number % kKept].load(std::memory_order_acquire);
  if (number == 0 || numberAt(found) != number) return std::nullopt;
  auto pin = pool_.tryPin(slotAt(found), number);
  if (!pin) return std::nullopt;
  return Found{std::move(*pin), &slots_[slotAt(found)]};
}

std::optional<DepthPin> DepthReader::tryBudget() noexcept {
  // Only this thread adds: between the two operations the number can only fall.
  if (held_.load(std::memory_order_acquire) >= pins_) {
    add(refused_, 1);
    return std::nullopt;
  }
  held_.fetch_add(1, std::memory_order_relaxed);
  return DepthPin(held_);
}

std::optional<PinnedDepth> DepthReader::tryPin(std::uint64_t number) noexcept {
  auto budget = tryBudget();
  if (!budget) return std::nullopt;
  auto found = board_.tryFind(number);
  if (!found) return std::nullopt;
  return PinnedDepth{.budget = std::move(*budget),
                     .pin = std::move(found->pin),
                     .picture = found->slot->picture,
                     .depth_mm = found->slot->depth_mm,
                     .colour_rgb = found->slot->colour_rgb};
}

std::optional<PinnedDepth> DepthReader::tryNewest() noexcept {
  const std::uint64_t newest = board_.newest();
  if (newest == last_) return std::nullopt;
  auto pinned = tryPin(newest);
  if (!pinned) return std::nullopt;  // out of budget, or stopped here for kKept pairs
  last_ = newest;
  add(taken_, 1);
  return pinned;
}

std::optional<PinnedDepth> DepthReader::tryNext() noexcept {
  for (std::uint64_t number = last_ + 1; number <= board_.newest(); ++number) {
    number = std::max(number, board_.oldest());
    const std::uint64_t refused = refused_.load(std::memory_order_relaxed);
    auto pinned = tryPin(number);
    if (!pinned && refused_.load(std::memory_order_relaxed) != refused) return std::nullopt;
    if (!pinned) continue;  // overwritten since
    add(lost_, number - last_ - 1);
    last_ = number;
    add(taken_, 1);
    return pinned;
  }
  return std::nullopt;
}

void DepthReader::seekBack(std::uint64_t pairs) noexcept {
  const std::uint64_t newest = board_.newest();
  last_ = std::max(newest - std::min(newest, pairs), board_.oldest() - 1);
}

DepthReaderStatus DepthReader::status() const {
  return {.name = name_,
          .pins = pins_,
          .pinned = held_.load(std::memory_order_relaxed),
          .taken = taken_.load(std::memory_order_relaxed),
          .lost = lost_.load(std::memory_order_relaxed),
          .refused = refused_.load(std::memory_order_relaxed)};
}

}  // namespace appliance
