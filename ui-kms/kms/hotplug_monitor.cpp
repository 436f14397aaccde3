#include "ui-kms/kms/hotplug_monitor.h"

#include <libudev.h>

namespace ui::kms {

void HotplugMonitor::Close::operator()(udev* context) const {
  udev_unref(context);
}
void HotplugMonitor::Close::operator()(udev_monitor* monitor) const {
  udev_monitor_unref(monitor);
}

HotplugMonitor::HotplugMonitor() : udev_(udev_new()) {
  if (!udev_) return;
  monitor_.reset(udev_monitor_new_from_netlink(udev_.get(), "kernel"));
  if (!monitor_) return;
  if (udev_monitor_filter_add_match_subsystem_devtype(monitor_.get(), "drm", nullptr) < 0 ||
      udev_monitor_enable_receiving(monitor_.get()) < 0) {
    monitor_.reset();
  }
}

bool HotplugMonitor::heard() {
  bool any = false;
  // The socket does not block: no message, no device.
  while (udev_device* device = monitor_ ? udev_monitor_receive_device(monitor_.get()) : nullptr) {
    any = true;
    udev_device_unref(device);
  }
  return any;
}

}  // namespace ui::kms
