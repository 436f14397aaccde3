#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <span>
#include <stop_token>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>

#include "hal/aravis/gobject.h"
#include "hal/aravis/profile_push.h"
#include "rt/memory.h"
#include "rt/unique_fd.h"
#include "tests/bench/reception/stream_receiver.h"

namespace bench {
namespace {

using hal::aravis::GlibError;
using hal::aravis::Ref;

// GigE Vision 2.0, bootstrap registers of the first stream channel.
constexpr guint64 kStreamPort = 0x0D00;
constexpr guint64 kStreamAddress = 0x0D18;

constexpr std::size_t kBatch = 64;       // packets per system call
constexpr std::size_t kHeaderBytes = 8;  // of GVSP: status, block id, format, packet id
constexpr std::uint32_t kIpUdpBytes = 28;

/// The camera's control side is Aravis' (heartbeat, settings); the packets come here.
class BareStream {
 public:
  BareStream() = default;
  BareStream(const BareStream&) = delete;
  BareStream& operator=(const BareStream&) = delete;
  ~BareStream() {
    thread_ = {};
    if (camera_) arv_camera_stop_acquisition(camera_.get(), nullptr);
  }

  std::expected<void, std::string> open(const hal::CameraProfile& profile,
                                        const ReceptionSetup& setup) {
    const auto fail = [&](const std::string& what) {
      return std::unexpected(profile.address + ": " + what);
    };
    frame_bytes_ = std::size_t{profile.width_px} * profile.height_px;
    packet_bytes_ = profile.packet_size_bytes - kIpUdpBytes;
    auto memory = rt::LockedArena::create(frame_bytes_ * setup.slots());
    if (!memory) return fail("no memory");
    memory_ = std::move(*memory);
    slots_ = setup.slots();
    const auto port = openSocket(static_cast<int>(profile.socket_buffer_bytes));
    if (port == 0) return fail(std::strerror(errno));
    auto thread =
        rt::Thread::start(setup.receive, [this](const std::stop_token& stop) { run(stop); });
    if (!thread) return fail("no thread");
    thread_ = std::move(*thread);

    GlibError error;
    camera_.reset(arv_camera_new(profile.address.c_str(), error.out()));
    if (!camera_) return fail(error.message());
    if (auto pushed = hal::aravis::pushProfile(camera_.get(), profile); !pushed) return pushed;
    ArvDevice* device = arv_camera_get_device(camera_.get());
    arv_device_write_register(device, kStreamAddress, INADDR_LOOPBACK, error.out());
    if (!error) arv_device_write_register(device, kStreamPort, port, error.out());
    if (!error) arv_camera_start_acquisition(camera_.get(), error.out());
    if (error) return fail(error.message());
    return {};
  }

  [[nodiscard]] std::uint64_t frames() const { return frames_.load(std::memory_order_relaxed); }

 private:
  std::uint16_t openSocket(int buffer_bytes) {
    socket_ = rt::UniqueFd(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    if (setsockopt(socket_.get(), SOL_SOCKET, SO_RCVBUFFORCE, &buffer_bytes, sizeof buffer_bytes) !=
        0) {
      setsockopt(socket_.get(), SOL_SOCKET, SO_RCVBUF, &buffer_bytes, sizeof buffer_bytes);
    }
    const timeval wait{.tv_sec = 0, .tv_usec = 100'000};  // so that it sees its stop
    setsockopt(socket_.get(), SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof wait);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* generic = reinterpret_cast<sockaddr*>(&address);
    if (bind(socket_.get(), generic, size) != 0) return 0;
    return getsockname(socket_.get(), generic, &size) == 0 ? ntohs(address.sin_port) : 0;
  }

  void run(const std::stop_token& stop) {
    std::vector<std::byte> scratch(kBatch * packet_bytes_);
    std::array<iovec, kBatch> pieces;
    std::array<mmsghdr, kBatch> messages{};
    for (std::size_t i = 0; i < kBatch; ++i) {
      pieces[i] = {scratch.data() + i * packet_bytes_, packet_bytes_};
      messages[i].msg_hdr.msg_iov = &pieces[i];
      messages[i].msg_hdr.msg_iovlen = 1;
    }
    while (!stop.stop_requested()) {
      const int count = recvmmsg(socket_.get(), messages.data(), kBatch, MSG_WAITFORONE, nullptr);
      for (int i = 0; i < count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        take({static_cast<const std::byte*>(pieces[at].iov_base), messages[at].msg_len});
      }
    }
  }

  void take(std::span<const std::byte> packet) {
    if (packet.size() < kHeaderBytes) return;
    const auto byte = [&](std::size_t i) { return std::to_integer<std::uint32_t>(packet[i]); };
    const std::uint32_t block = byte(2) << 8U | byte(3);
    const std::uint32_t format = byte(4) & 0x0FU;  // 1 leader, 2 trailer, 3 payload
    const std::uint32_t id = byte(5) << 16U | byte(6) << 8U | byte(7);
    if (block != block_) {
      block_ = block;
      filled_ = 0;
      slot_ = (slot_ + 1) % slots_;
    }
    if (format == 3 && id > 0) {
      const std::size_t payload = packet.size() - kHeaderBytes;
      const std::size_t offset = std::size_t{id - 1} * (packet_bytes_ - kHeaderBytes);
      if (offset + payload > frame_bytes_) return;
      std::memcpy(memory_.bytes().data() + slot_ * frame_bytes_ + offset,
                  packet.data() + kHeaderBytes, payload);
      filled_ += payload;
    } else if (format == 2 && filled_ == frame_bytes_) {
      frames_.store(frames() + 1, std::memory_order_relaxed);
    }
  }

  Ref<ArvCamera> camera_;
  rt::UniqueFd socket_;
  std::size_t frame_bytes_ = 0;
  std::size_t packet_bytes_ = 0;  // GVSP header and payload
  rt::LockedArena memory_;
  std::size_t slots_ = 0;
  std::atomic<std::uint64_t> frames_{0};
  // The receive thread's.
  std::uint32_t block_ = 0;
  std::size_t slot_ = 0;
  std::size_t filled_ = 0;
  rt::Thread thread_;  // last: it uses all of the above
};

}  // namespace

MadeReceiver receiveByRecvmmsg(const ReceptionSetup& setup) {
  return openStreams<BareStream>(setup);
}

}  // namespace bench
