#pragma once

#include <string>

namespace test {

/// A virtual graphics card of our own with one CRTC, one screen that can be unplugged, and a
/// writeback connector. The bed's own card, /dev/dri/card0, stays beside it.
///
/// Errors   Everything throws std::runtime_error with what the kernel refused.
class Vkms {
 public:
  /// Whether this kernel can make cards at run time; 6.12 cannot, and its screen stays plugged in.
  [[nodiscard]] static bool available();

  /// @p name is also the card's name in /sys/devices/faux and /sys/kernel/debug/dri.
  explicit Vkms(std::string name, bool connected = true);
  ~Vkms();
  Vkms(const Vkms&) = delete;
  Vkms& operator=(const Vkms&) = delete;

  /// Plugs the screen in or out; the kernel informs every listener, as for a true cable.
  void setConnected(bool connected);

  [[nodiscard]] const std::string& card() const { return card_; }  ///< "/dev/dri/card1"
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  std::string name_;
  std::string config_;  // its folder in configfs
  std::string card_;
};

}  // namespace test
