#pragma once

#include <cstdint>
#include <expected>
#include <memory>
#include <string>
#include <vector>

#include "rt/clock.h"
#include "rt/unique_fd.h"

namespace ui::kms {

/// A page flip as the kernel reports it.
struct FlipEvent {
  std::uint64_t serial;    ///< of AtomicRequest::submit()
  std::uint32_t sequence;  ///< the vblank's number; wraps
  rt::Timestamp at;        ///< the vblank's instant, in whole microseconds
};

/// One graphics card that drives screens: /dev/dri/cardN.
///
/// A card obeys one program at a time, its master. Who opens it first is master already; afterwards
/// the role is dropped and taken.
///
/// Threads  One.
/// Errors   open(): one line: no card, no permission, or a driver without atomic mode setting.
class Device {
 public:
  /// @p path empty: the first card with a screen, or else the first that could drive one.
  [[nodiscard]] static std::expected<std::unique_ptr<Device>, std::string> open(
      const std::string& path);

  [[nodiscard]] int fd() const { return fd_.get(); }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const std::string& driver() const { return driver_; }

  /// Whether we are master now. If not, an errno: EBUSY: another program is; EACCES: not permitted.
  [[nodiscard]] std::expected<void, int> tryTakeMaster() const;
  void dropMaster() const;

  /// Appends the flips since the last call, oldest first. Never waits.
  void readFlips(std::vector<FlipEvent>& flips) const;

 private:
  Device(rt::UniqueFd fd, std::string path, std::string driver);

  rt::UniqueFd fd_;
  std::string path_;
  std::string driver_;
};

}  // namespace ui::kms
