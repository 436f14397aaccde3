#include "hal/openni/worker.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include "hal/openni/wire.h"

namespace hal::openni {
namespace {

using namespace std::chrono_literals;
using Kind = WireMessage::Kind;

constexpr rt::Nanoseconds kLook = 50ms;  // for a device that is not there
constexpr rt::Nanoseconds kTurn = 100ms;
constexpr rt::Nanoseconds kSignOfLife = 1s;

/// A vendor's code shall not run with the daemon's privileges: it is the first to go when memory
/// is short, never real-time, and its crashes leave no core files.
void dropPrivileges() {
  constexpr rlimit kNone{.rlim_cur = 0, .rlim_max = 0};
  (void)::setrlimit(RLIMIT_CORE, &kNone);
  (void)::setrlimit(RLIMIT_RTPRIO, &kNone);
  std::ofstream("/proc/self/oom_score_adj") << 500;
}

/// The supervisor's end is the only reason to stop that a blocking driver could not hide from us.
void endWithSupervisor(int socket) {
  std::thread([socket] {
    pollfd end{.fd = socket, .events = 0, .revents = 0};
    while (::poll(&end, 1, -1) < 0 || (end.revents & (POLLHUP | POLLERR)) == 0) {
    }
    std::this_thread::sleep_for(300ms);  // the main thread's chance to close the device
    ::_exit(0);
  }).detach();
}

class Slots {
 public:
  Slots(std::uint32_t width_px, std::uint32_t height_px)
      : slot_bytes_(wireSlotBytes(width_px, height_px)),
        bytes_(kWireSlots * slot_bytes_),
        descriptor_(::memfd_create("kagami-depth", MFD_CLOEXEC | MFD_ALLOW_SEALING)) {
    if (!descriptor_.valid() || ::ftruncate(descriptor_.get(), static_cast<off_t>(bytes_)) != 0) {
      return;
    }
    // The supervisor maps it: it must not lose pages under a reader.
    if (::fcntl(descriptor_.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW) != 0) return;
    void* at = ::mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_.get(), 0);
    if (at != MAP_FAILED) memory_ = static_cast<std::byte*>(at);
  }
  ~Slots() {
    if (memory_ != nullptr) ::munmap(memory_, bytes_);
  }
  Slots(const Slots&) = delete;
  Slots& operator=(const Slots&) = delete;

  [[nodiscard]] bool valid() const { return memory_ != nullptr; }
  [[nodiscard]] int descriptor() const { return descriptor_.get(); }
  void release(std::uint32_t slot) {
    if (slot < kWireSlots) lent_[slot] = false;
  }
  [[nodiscard]] std::optional<std::uint32_t> tryFill(const DevicePair& pair) {
    const auto free = std::ranges::find(lent_, false);
    if (free == lent_.end()) return std::nullopt;
    *free = true;
    const auto slot = static_cast<std::uint32_t>(free - lent_.begin());
    std::byte* at = memory_ + slot * slot_bytes_;
    for (const auto bytes : {std::as_bytes(pair.depth_mm), std::as_bytes(pair.colour_rgb)}) {
      if (!bytes.empty()) std::memcpy(at, bytes.data(), bytes.size());
      at += bytes.size();
    }
    return slot;
  }

 private:
  std::size_t slot_bytes_;
  std::size_t bytes_;
  rt::UniqueFd descriptor_;
  std::byte* memory_ = nullptr;
  std::array<bool, kWireSlots> lent_{};
};

/// Takes what the supervisor says, waiting for it no longer than @p timeout. False: it is gone.
bool listen(int socket, Slots& slots, rt::Nanoseconds timeout) {
  pollfd wire{.fd = socket, .events = POLLIN, .revents = 0};
  (void)::poll(&wire, 1, static_cast<int>(timeout / 1ms));
  for (Received received;;) {
    switch (tryReceive(socket, received)) {
      case ReceiveResult::kClosed:
      case ReceiveResult::kForeign:
        return false;
      case ReceiveResult::kNothing:
        return true;
      case ReceiveResult::kMessage:
        if (received.message.kind == Kind::kRelease) slots.release(received.message.slot);
    }
  }
}

int fail(int socket, const std::string& why, bool unplugged = false) {
  WireMessage message{.kind = Kind::kFail, .unplugged = unplugged};
  message.setText(why);
  (void)send(socket, message);
  return 1;
}

/// Waits for a device as long as there is a supervisor. Signs of life show the supervisor that
/// the driver still looks for it.
bool waitForDevice(int socket, const std::string& source) {
  bool told = false;
  rt::Timestamp alive_at = rt::now() + kSignOfLife;
  while (!Device::present(source)) {
    if (!told) {
      WireMessage note{.kind = Kind::kNote};
      note.setText(source.empty()
                       ? "no depth sensor found: plug it in, or check depth_sensor.drivers"
                       : "depth sensor " + source +
                             " not found: plug it in, or check "
                             "depth_sensor.source and depth_sensor.drivers");
      if (!send(socket, note)) return false;
      told = true;
    }
    if (rt::now() >= alive_at) {
      if (!send(socket, {.kind = Kind::kAlive})) return false;
      alive_at = rt::now() + kSignOfLife;
    }
    std::this_thread::sleep_for(kLook);
  }
  return true;
}

WireMessage hello(const Device::Facts& facts) {
  WireMessage message{.kind = Kind::kHello,
                      .width_px = facts.width_px,
                      .height_px = facts.height_px,
                      .colour = facts.colour,
                      .recording = facts.recording,
                      .lens = facts.lens,
                      .colour_lens = facts.colour_lens};
  message.setText(facts.name);
  return message;
}

/// Depth sensor remarks in one line, as `kagami status` shows them.
std::string remarksOf(const Device::Facts& facts) {
  std::string all;
  for (const std::string& remark : facts.remarks) all += (all.empty() ? "" : "; ") + remark;
  return all.empty() ? all : "depth sensor " + facts.name + ": " + all;
}

int stream(int socket, Device& device, Slots& slots) {
  for (DevicePair pair;;) {
    if (!listen(socket, slots, 0ns)) return 0;
    switch (device.next(kTurn, pair)) {
      case Device::Answer::kNothing:
        continue;
      case Device::Answer::kGone:
        return fail(socket,
                    "depth sensor " + device.facts().name + " was unplugged: plug it in again",
                    true);
      case Device::Answer::kEnd:
        // Not the end of this process yet: the last pictures are still on loan.
        if (!send(socket, {.kind = Kind::kEnd})) return 0;
        while (listen(socket, slots, kTurn)) {
        }
        return 0;
      case Device::Answer::kPair:
        break;
    }
    auto slot = slots.tryFill(pair);
    // A recording waits for its reader; live, a picture that no reader takes is lost and counted.
    while (!slot && device.facts().recording) {
      if (!listen(socket, slots, kTurn)) return 0;
      slot = slots.tryFill(pair);
    }
    if (!slot) continue;
    const WireMessage full{.kind = Kind::kFrame,
                           .slot = *slot,
                           .with_colour = !pair.colour_rgb.empty(),
                           .number = pair.number,
                           .stamp_us = pair.stamp_us,
                           .colour_stamp_us = pair.colour_stamp_us,
                           .frame_ready_ns = rt::toNs(pair.frame_ready)};
    if (!send(socket, full)) return 0;
  }
}

}  // namespace

int runWorker(int socket, const DeviceRequest& request, DriverStage stage) {
  dropPrivileges();
  endWithSupervisor(socket);
  if (auto started = Device::startLibrary(); !started) return fail(socket, started.error());
  if (!waitForDevice(socket, request.source)) return 0;
  auto device = Device::open(request);
  stage.remove();
  if (!device) return fail(socket, device.error());
  const Device::Facts& facts = (*device)->facts();
  Slots slots(facts.width_px, facts.height_px);
  if (!slots.valid()) return fail(socket, "depth sensor: no memory for its pictures: free some");
  WireMessage note{.kind = Kind::kNote};
  note.setText(remarksOf(facts));
  if (!send(socket, note) || !send(socket, hello(facts), slots.descriptor())) return 0;
  return stream(socket, **device, slots);
}

}  // namespace hal::openni
