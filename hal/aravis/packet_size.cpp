#include "hal/aravis/packet_size.h"

#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <memory>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "hal/aravis/gobject.h"
#include "rt/clock.h"

namespace hal::aravis {
namespace {

// Bootstrap registers of stream channel 0 (GigE Vision).
constexpr guint64 kPortRegister = 0x0d00;
constexpr guint64 kSizeRegister = 0x0d04;
constexpr guint64 kDestinationRegister = 0x0d18;
constexpr std::uint32_t kFireTestPacket = 1U << 31;
constexpr std::uint32_t kDoNotFragment = 1U << 30;

constexpr std::uint32_t kIpAndUdpBytes = 28;
constexpr std::uint32_t kEthernetBytes = 38;
constexpr std::array<std::uint32_t, 5> kUsualSizes = {8192, 4000, 1500, 1400, 576};
constexpr int kTries = 3;  // a single packet may be lost for another reason
constexpr rt::Nanoseconds kAnswerTime = std::chrono::milliseconds(70);

/// Where the camera's test packets go: a UDP socket on the address that this machine has towards
/// the camera.
class Receiver {
 public:
  explicit Receiver(ArvGvDevice* device) {
    const Ref<GSocketAddress> interface{
        G_SOCKET_ADDRESS(g_object_ref(arv_gv_device_get_interface_address(device)))};
    sockaddr_in local{};
    GlibError error;
    if (g_socket_address_to_native(interface.get(), &local, sizeof local, error.out()) == FALSE) {
      return;
    }
    local.sin_port = 0;
    address_ = ntohl(local.sin_addr.s_addr);
    fd_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    socklen_t size = sizeof local;
    auto* native = reinterpret_cast<sockaddr*>(&local);
    if (fd_ < 0 || bind(fd_, native, size) != 0 || getsockname(fd_, native, &size) != 0) return;
    port_ = ntohs(local.sin_port);
  }
  ~Receiver() {
    if (fd_ >= 0) close(fd_);
  }
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;

  [[nodiscard]] std::uint32_t address() const { return address_; }  // host order
  [[nodiscard]] std::uint16_t port() const { return port_; }        // 0: there is no socket

  /// Whether a datagram of just this size comes in time.
  [[nodiscard]] bool waitFor(std::uint32_t bytes) const {
    const rt::Timestamp end = rt::now() + kAnswerTime;
    for (rt::Timestamp now = rt::now(); now < end; now = rt::now()) {
      pollfd wait{.fd = fd_, .events = POLLIN, .revents = 0};
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - now);
      if (poll(&wait, 1, static_cast<int>(left.count())) <= 0) continue;
      std::array<std::byte, 16> first{};
      const ssize_t length = recv(fd_, first.data(), first.size(), MSG_TRUNC);
      if (length == static_cast<ssize_t>(bytes)) return true;
    }
    return false;
  }

 private:
  int fd_ = -1;
  std::uint32_t address_ = 0;
  std::uint16_t port_ = 0;
};

bool write(ArvDevice* device, guint64 address, std::uint32_t value) {
  GlibError error;
  return arv_device_write_register(device, address, value, error.out()) != FALSE && !error;
}

bool arrives(ArvDevice* device, const Receiver& receiver, std::uint32_t bytes) {
  for (int i = 0; i < kTries; ++i) {
    if (!write(device, kSizeRegister, kFireTestPacket | kDoNotFragment | bytes)) return false;
    if (receiver.waitFor(bytes - kIpAndUdpBytes)) return true;
  }
  return false;
}

/// "raise the MTU of eth1 (1500)", or of what lies beyond it.
std::string whereTheMtuIs(std::uint32_t address, std::uint32_t asked_bytes) {
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return "raise the MTU on its way";
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> owned(all, &freeifaddrs);
  for (const ifaddrs* one = all; one != nullptr; one = one->ifa_next) {
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
    const auto* ipv4 = reinterpret_cast<const sockaddr_in*>(one->ifa_addr);
    if (ntohl(ipv4->sin_addr.s_addr) != address) continue;
    std::uint32_t mtu = 0;
    std::ifstream("/sys/class/net/" + std::string(one->ifa_name) + "/mtu") >> mtu;
    const std::string named = std::string(one->ifa_name) + " (" + std::to_string(mtu) + ")";
    if (mtu < asked_bytes) return "raise the MTU of " + named;
    return "raise the MTU of the switch; " + named + " is large enough";
  }
  return "raise the MTU on its way";
}

}  // namespace

std::vector<std::uint32_t> packetSizesBelow(std::uint32_t asked_bytes) {
  std::vector<std::uint32_t> sizes{asked_bytes};
  for (const std::uint32_t usual : kUsualSizes) {
    if (usual < asked_bytes) sizes.push_back(usual);
  }
  return sizes;
}

std::uint32_t delayForSize(const CameraProfile& profile, std::uint32_t bytes) {
  const double share =
      static_cast<double>(bytes + kEthernetBytes) / (profile.packet_size_bytes + kEthernetBytes);
  return static_cast<std::uint32_t>(std::lround(profile.packet_delay_ns * share));
}

PacketSize provePacketSize(ArvCamera* camera, const CameraProfile& profile) {
  const std::uint32_t asked = profile.packet_size_bytes;
  const std::string lost = "packets of " + std::to_string(asked) + " bytes do not arrive: ";
  ArvDevice* device = arv_camera_get_device(camera);
  const Receiver receiver(ARV_GV_DEVICE(device));
  PacketSize proven{.bytes = asked, .delay_ns = profile.packet_delay_ns, .note = {}};
  if (receiver.port() == 0 || !write(device, kDestinationRegister, receiver.address()) ||
      !write(device, kPortRegister, receiver.port())) {
    return proven;  // the stream will say what is wrong
  }
  bool found = false;
  for (const std::uint32_t bytes : packetSizesBelow(asked)) {
    found = arrives(device, receiver, bytes);
    if (!found) continue;
    proven.bytes = bytes;
    break;
  }
  (void)write(device, kPortRegister, 0);  // closes the channel
  (void)write(device, kSizeRegister, kDoNotFragment | proven.bytes);
  if (!found) {
    proven.note = "no test packet arrives, of whatever size: packets of " + std::to_string(asked) +
                  " bytes are not proven: check the firewall";
  } else if (proven.bytes != asked) {
    proven.delay_ns = delayForSize(profile, proven.bytes);
    proven.note =
        lost + std::to_string(proven.bytes) + " used; " + whereTheMtuIs(receiver.address(), asked);
  }
  return proven;
}

}  // namespace hal::aravis
