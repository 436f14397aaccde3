#include "hal/emulated/rig/control_channel.h"

namespace emulator {

bool ControlChannel::mayRead(const Peer& peer) const {
  return (privilege_ & kExclusive) == 0 || controller_ == peer;
}

gvcp::Status ControlChannel::request(const Peer& peer, std::uint32_t privilege, rt::Timestamp now) {
  if (controller_ && controller_ != peer) return gvcp::Status::kAccessDenied;
  if ((privilege & (kExclusive | kControl)) == 0) {
    release();
    return gvcp::Status::kSuccess;
  }
  controller_ = peer;
  privilege_ = privilege & (kExclusive | kControl);
  last_heard_ = now;
  return gvcp::Status::kSuccess;
}

void ControlChannel::hear(const Peer& peer, rt::Timestamp now) {
  if (controller_ == peer) last_heard_ = now;
}

bool ControlChannel::expire(rt::Timestamp now, rt::Nanoseconds timeout) {
  if (!controller_ || now - last_heard_ <= timeout) return false;
  release();
  return true;
}

void ControlChannel::release() {
  controller_.reset();
  privilege_ = 0;
}

}  // namespace emulator
