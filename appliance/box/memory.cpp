#include "appliance/box/memory.h"

#include <cstdint>
#include <utility>

#include "rt/memory.h"

namespace appliance {
namespace {

constexpr std::uint32_t kFewestSets = 8;

std::string historyTooLarge(const HistoryLayout& layout, std::uint64_t available) {
  return withId(phrase<Word::kHistoryTooLarge>(layout.sets,
                                               static_cast<double>(layout.bytes()) * 1e-9,
                                               static_cast<double>(available) * 1e-9));
}

}  // namespace

std::expected<std::unique_ptr<FrameHistory>, std::string> makeHistory(const Config& config,
                                                                      const Rig& rig,
                                                                      const HistoryUse& use,
                                                                      Remarks& remarks) {
  HistoryLayout layout{.frame_bytes = {},
                       .sets = config.history.sets,
                       .in_flight = config.history.in_flight,
                       .reserve = use.pins_per_camera};
  for (const RigCamera& camera : rig.cameras) {
    layout.frame_bytes.push_back(std::size_t{camera.width_px} * camera.height_px);
  }
  const std::uint64_t available = rt::availableMemoryBytes();
  const std::uint64_t margin = rt::LockedArena::kMarginBytes;
  const auto fitted = fitHistory(layout, available > margin ? available - margin : 0, kFewestSets);
  if (!fitted || (fitted->sets < layout.sets && !config.history.size_down)) {
    return std::unexpected(historyTooLarge(layout, available));
  }
  if (fitted->sets < layout.sets) {
    remarks.add("history", phrase<Word::kHistoryShort>(
                               fitted->sets, fitted->sets / config.trigger.rate_hz, layout.sets));
  }
  return FrameHistory::create(*fitted,
                              use.shared ? HistorySharing::kShared : HistorySharing::kPrivate);
}

std::expected<void, std::string> lockMemory(const RealtimeSettings& realtime,
                                            const FrameHistory& history, Remarks& remarks) {
  if (!realtime.lock_memory) return {};
  const rt::MemoryLock lock = rt::lockMemory();
  if (lock.locked && history.memory().report().locked) return {};
  const Phrase unlocked =
      lock.locked ? phrase<Word::kHistoryUnlocked>() : phrase<Word::kMemoryUnlocked>(lock.message);
  if (realtime.require) return std::unexpected(withId(unlocked));
  remarks.add("memory", unlocked);
  return {};
}

}  // namespace appliance
