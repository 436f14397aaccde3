#pragma once

#include <cstdint>
#include <optional>

#include "hal/emulated/rig/gvcp.h"
#include "rt/clock.h"

namespace emulator {

/// Who may configure a camera: at most one controller, kept alive by its heartbeat. Pure.
class ControlChannel {
 public:
  struct Peer {
    std::uint32_t address = 0;
    std::uint16_t port = 0;
    friend bool operator==(const Peer&, const Peer&) = default;
  };

  static constexpr std::uint32_t kExclusive = 1;
  static constexpr std::uint32_t kControl = 2;

  [[nodiscard]] bool mayRead(const Peer& peer) const;
  [[nodiscard]] bool mayWrite(const Peer& peer) const { return controller_ == peer; }
  /// Packets are asked for again by the controller's machine, often from another port.
  [[nodiscard]] bool mayAskAgain(const Peer& peer) const {
    return controller_ && controller_->address == peer.address;
  }
  [[nodiscard]] bool isHeld() const { return controller_.has_value(); }
  [[nodiscard]] const std::optional<Peer>& controller() const { return controller_; }
  /// What the control privilege register reads.
  [[nodiscard]] std::uint32_t privilege() const { return privilege_; }

  /// A write of the control privilege register; zero gives control back.
  gvcp::Status request(const Peer& peer, std::uint32_t privilege, rt::Timestamp now);
  /// Any command of the controller is a heartbeat.
  void hear(const Peer& peer, rt::Timestamp now);
  /// Frees control when the controller was silent for longer than @p timeout; true when it did.
  bool expire(rt::Timestamp now, rt::Nanoseconds timeout);
  [[nodiscard]] rt::Timestamp lastHeard() const { return last_heard_; }
  void release();

 private:
  std::optional<Peer> controller_;
  std::uint32_t privilege_ = 0;
  rt::Timestamp last_heard_;
};

}  // namespace emulator
