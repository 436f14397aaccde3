#pragma once

#include <memory>

struct udev;
struct udev_monitor;

namespace ui::kms {

/// Hears what the kernel says about graphics cards: a screen came, went or changed. It listens to
/// the kernel itself, so that it works without the udev daemon.
///
/// Threads  One.
/// Errors   If listening is not permitted, it reports nothing: the caller must poll.
class HotplugMonitor {
 public:
  HotplugMonitor();

  /// Whether something was heard since the last call. Never waits.
  [[nodiscard]] bool heard();

 private:
  struct Close {
    void operator()(udev* context) const;
    void operator()(udev_monitor* monitor) const;
  };
  std::unique_ptr<udev, Close> udev_;
  std::unique_ptr<udev_monitor, Close> monitor_;
};

}  // namespace ui::kms
