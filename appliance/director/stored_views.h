#pragma once

#include <cstddef>
#include <cstdint>

#include "rt/annotations.h"

namespace appliance {

/// More views than any arc we build; fixed so that real-time code can use arrays.
inline constexpr std::size_t kMostViews = 64;

/// Triggers of which frames are stored, both ends included; 0, 0 when there are none.
struct StoredRange {
  std::uint64_t oldest = 0;
  std::uint64_t newest = 0;

  [[nodiscard]] bool empty() const { return newest == 0; }
};

/// What the director asks the frame history (and the tests' stand-in) before each decision.
///
/// Threads  The render thread, inside Director::tick().
/// RT       Every member is RT safe.
class StoredViews {
 public:
  virtual ~StoredViews() = default;

  [[nodiscard]] virtual std::uint32_t cameras() const RT_SAFE = 0;
  /// From the oldest to the newest complete frame of a camera; frames in between may be missing.
  [[nodiscard]] virtual StoredRange range(std::uint32_t camera) const RT_SAFE = 0;
  /// Whether the complete frame of exactly that trigger can be shown now.
  [[nodiscard]] virtual bool holds(std::uint32_t camera, std::uint64_t trigger) const RT_SAFE = 0;
  /// The moment whose frames are held for a stopped picture, whatever the memory forgets; 0: none.
  [[nodiscard]] virtual std::uint64_t heldTrigger() const RT_SAFE { return 0; }
  /// Whether the camera delivers.
  [[nodiscard]] virtual bool living(std::uint32_t camera) const RT_SAFE = 0;
  /// Whether the target lies in the camera's picture. Without geometry every camera sees it.
  [[nodiscard]] virtual bool sees(std::uint32_t /*camera*/) const RT_SAFE { return true; }
};

}  // namespace appliance
