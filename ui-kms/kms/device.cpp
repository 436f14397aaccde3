#include "ui-kms/kms/device.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <unistd.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

#include "ui-kms/kms/connector.h"

namespace ui::kms {
namespace {

constexpr int kMostCards = 16;

std::string cannotOpen(const std::string& path, int error) {
  std::string line = path + " does not open: " + std::strerror(error);
  if (error == EACCES || error == EPERM) line += ": let the user be in the group that owns it";
  if (error == ENOENT) line += ": check display.device, or load the graphics driver";
  return line;
}

std::string driverOf(int fd) {
  const std::unique_ptr<drmVersion, decltype(&drmFreeVersion)> version(drmGetVersion(fd),
                                                                       &drmFreeVersion);
  return version ? std::string(version->name, static_cast<std::size_t>(version->name_len))
                 : std::string("unknown");
}

bool drivesScreens(int fd) {
  const std::unique_ptr<drmModeRes, decltype(&drmModeFreeResources)> resources(
      drmModeGetResources(fd), &drmModeFreeResources);
  return resources && resources->count_connectors > 0 && resources->count_crtcs > 0;
}

}  // namespace

Device::Device(rt::UniqueFd fd, std::string path, std::string driver)
    : fd_(std::move(fd)), path_(std::move(path)), driver_(std::move(driver)) {}

std::expected<std::unique_ptr<Device>, std::string> Device::open(const std::string& path) {
  if (path.empty()) {
    std::unique_ptr<Device> first;
    std::string why;
    for (int i = 0; i < kMostCards; ++i) {
      const std::string card = "/dev/dri/card" + std::to_string(i);
      if (::access(card.c_str(), F_OK) != 0) continue;
      auto device = open(card);
      if (!device) {
        if (why.empty()) why = device.error();
        continue;
      }
      if (findConnector((*device)->fd(), Probe::kKnown)) return device;
      if (!first) first = std::move(*device);
    }
    if (first) return first;
    if (!why.empty()) return std::unexpected(why);
    return std::unexpected(
        std::string("no DRM device: /dev/dri has no card: load the graphics driver"));
  }

  rt::UniqueFd fd(::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK));
  if (!fd.valid()) return std::unexpected(cannotOpen(path, errno));
  if (!drivesScreens(fd.get())) {
    return std::unexpected(path + " drives no screens: give another card as display.device");
  }
  std::string driver = driverOf(fd.get());
  if (drmSetClientCap(fd.get(), DRM_CLIENT_CAP_ATOMIC, 1) != 0) {
    return std::unexpected(path + ": its driver " + driver +
                           " has no atomic mode setting: use a card or a kernel that has");
  }
  // So that what another program left attached to our screen can be seen and undone.
  static_cast<void>(drmSetClientCap(fd.get(), DRM_CLIENT_CAP_WRITEBACK_CONNECTORS, 1));
  return std::unique_ptr<Device>(new Device(std::move(fd), path, std::move(driver)));
}

std::expected<void, int> Device::tryTakeMaster() const {
  if (drmIsMaster(fd()) != 0 || drmSetMaster(fd()) == 0) return {};
  return std::unexpected(errno);
}

void Device::dropMaster() const {
  static_cast<void>(drmDropMaster(fd()));
}

void Device::readFlips(std::vector<FlipEvent>& flips) const {
  alignas(drm_event_vblank) std::array<std::byte, 1024> bytes;
  while (true) {
    const ssize_t length = ::read(fd(), bytes.data(), bytes.size());
    if (length <= 0) return;  // the descriptor does not block: nothing more for now
    std::size_t at = 0;
    while (at + sizeof(drm_event) <= static_cast<std::size_t>(length)) {
      drm_event head{};
      std::memcpy(&head, &bytes[at], sizeof head);
      if (head.type == DRM_EVENT_FLIP_COMPLETE && head.length >= sizeof(drm_event_vblank)) {
        drm_event_vblank flip{};
        std::memcpy(&flip, &bytes[at], sizeof flip);
        flips.push_back({.serial = flip.user_data,
                         .sequence = flip.sequence,
                         .at = rt::Timestamp(std::chrono::seconds(flip.tv_sec) +
                                             std::chrono::microseconds(flip.tv_usec))});
      }
      at += std::max<std::size_t>(head.length, sizeof head);
    }
  }
}

}  // namespace ui::kms
