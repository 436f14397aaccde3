#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "appliance/capture/camera_frames.h"
#include "rt/annotations.h"
#include "rt/pin_budget.h"

namespace appliance {

class FrameHistory;

/// What one reader does with its budget.
struct ReaderReport {
  std::string name;
  std::uint32_t pins_per_camera = 0;
  std::uint32_t most_pinned = 0;  ///< now, of the camera of which it pins the most
  std::uint64_t refused = 0;      ///< pins that it asked for beyond its budget
};

/// One reader's access to the frame history. It may pin so many frames of each camera together, and
/// no more; whatever it keeps, the cameras and the other readers have all that they need.
///
/// Threads  tryPin(), pinned(): any, several together if the reader has several threads. report():
///          any but a real-time one.
/// RT       tryPin() is lock-free.
/// Memory   Belongs to the history. Every pin ends before the history does.
class FrameReader {
 public:
  /// See FrameHistory::openReader().
  FrameReader(FrameHistory& history, std::string name, std::uint32_t pins_per_camera);
  FrameReader(const FrameReader&) = delete;
  FrameReader& operator=(const FrameReader&) = delete;

  /// The frame of that trigger; nothing if it is not stored, or beyond the budget.
  [[nodiscard]] std::optional<PinnedFrame> tryPin(std::uint32_t camera,
                                                  std::uint64_t trigger) RT_SAFE;

  [[nodiscard]] const FrameHistory& history() const RT_SAFE { return history_; }
  [[nodiscard]] std::uint32_t pinsPerCamera() const RT_SAFE { return pins_per_camera_; }
  [[nodiscard]] std::uint32_t pinned(std::uint32_t camera) const RT_SAFE {
    return budgets_[camera].used();
  }
  [[nodiscard]] ReaderReport report() const;

 private:
  FrameHistory& history_;
  const std::string name_;
  const std::uint32_t pins_per_camera_;
  std::deque<rt::PinBudget> budgets_;  // one per camera; a budget cannot move
};

}  // namespace appliance
