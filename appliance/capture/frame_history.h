#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "appliance/capture/camera_frames.h"
#include "appliance/capture/frame_reader.h"
#include "appliance/capture/shared_slots.h"
#include "appliance/words/phrase.h"
#include "rt/annotations.h"
#include "rt/memory.h"

namespace appliance {

/// How much is kept, in frames per camera.
struct HistoryLayout {
  std::vector<std::size_t> frame_bytes;  ///< per camera
  std::uint32_t sets = 300;              ///< the memory that people see: sets / trigger rate
  std::uint32_t in_flight = 8;           ///< in the cameras' hands
  std::uint32_t reserve = 4;             ///< pins of all readers together: the sum of their budgets

  /// One more than fill, are stored and are pinned: store() takes the next slot before it retires.
  [[nodiscard]] std::size_t slots() const { return std::size_t{sets} + in_flight + reserve + 1; }
  /// What the layout takes, every slot rounded up to whole pages.
  [[nodiscard]] std::size_t bytes() const;
};

/// Fewer sets if @p available_bytes is less than the layout asks for; nothing if not even
/// @p fewest_sets fit.
[[nodiscard]] std::optional<HistoryLayout> fitHistory(HistoryLayout layout,
                                                      std::size_t available_bytes,
                                                      std::uint32_t fewest_sets);

/// Whether a GPU may read the frames in their slots.
enum class HistorySharing : std::uint8_t { kPrivate, kShared };

/// The frame history of the rig: one block of locked memory, cut into every camera's slots.
///
/// Threads  create(): a SCHED_OTHER thread, blocks for seconds while memory is prefaulted.
///          openReader(): set-up, before any thread reads or stores. readers(): the owner.
/// Errors   create(), openReader(): one line for a person.
class FrameHistory {
 public:
  [[nodiscard]] static std::expected<std::unique_ptr<FrameHistory>, std::string> create(
      const HistoryLayout& layout, HistorySharing sharing = HistorySharing::kPrivate);

  /// A reader that may pin so many frames of each camera together; @p name is for people. It lives
  /// as long as the history. Refused if the readers together would exceed HistoryLayout::reserve.
  [[nodiscard]] std::expected<FrameReader*, std::string> openReader(std::string name,
                                                                    std::uint32_t pins_per_camera);
  [[nodiscard]] std::vector<ReaderReport> readers() const;
  /// Readers that were refused a pin, one line each.
  [[nodiscard]] std::vector<Phrase> remarks() const;

  [[nodiscard]] CameraFrames& camera(std::uint32_t index) RT_SAFE { return *cameras_[index]; }
  [[nodiscard]] const CameraFrames& camera(std::uint32_t index) const RT_SAFE {
    return *cameras_[index];
  }
  [[nodiscard]] std::uint32_t cameras() const RT_SAFE {
    return static_cast<std::uint32_t>(cameras_.size());
  }
  [[nodiscard]] std::uint32_t sets() const { return sets_; }
  [[nodiscard]] const rt::LockedArena& memory() const { return arena_; }
  /// Why a history that should be shared is not, in one line; empty otherwise.
  [[nodiscard]] const std::string& notShared() const { return not_shared_; }

 private:
  FrameHistory(rt::LockedArena arena, const HistoryLayout& layout, HistorySharing sharing);
  [[nodiscard]] std::optional<SharedSlots> share(const HistoryLayout& layout);

  rt::LockedArena arena_;
  std::string not_shared_;
  std::optional<SharedSlots> shared_;
  std::uint32_t sets_;
  std::uint32_t unclaimed_pins_;  // of the reserve, per camera
  std::vector<std::unique_ptr<CameraFrames>> cameras_;
  std::vector<std::unique_ptr<FrameReader>> readers_;
};

}  // namespace appliance
