#pragma once

#include <cstdint>
#include <utility>

namespace test {

/// What VKMS cannot be: another screen on the same cable. While one of these lives, the program's
/// own calls of libdrm are answered differently; everything else stays the kernel's.
struct OtherScreen {
  /// The screen offers modes of this size only; 0: all.
  static void offerOnly(std::uint32_t width_px, std::uint32_t height_px);
  /// The connectors' link-status reads bad until a mode is set again.
  static void breakLink();
  /// The driver has no atomic mode setting.
  static void refuseAtomic(bool refuse);
  /// The driver refuses the next commits that would set a mode.
  static void refuseModes(int commits);
};

}  // namespace test
