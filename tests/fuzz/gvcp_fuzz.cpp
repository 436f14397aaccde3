#include <memory>

#include <arpa/inet.h>

#include "hal/emulated/rig/camera.h"
#include "hal/emulated/rig/device_xml.h"
#include "tests/fuzz/fuzz_target.h"

namespace {

using namespace emulator;  // NOLINT(google-build-using-namespace)

constexpr SizePx kSensor{64, 32};
constexpr std::uint32_t kMaxPacketBytes = 9000;
constexpr int kNoSocket = -1;  // an input may name any destination: nothing leaves this process

class GreyScene final : public Scene {
 public:
  [[nodiscard]] std::uint32_t cameraCount() const override { return 1; }
  [[nodiscard]] SizePx sensorSize(std::uint32_t /*camera*/) const override { return kSensor; }
  [[nodiscard]] std::string cameraName(std::uint32_t /*camera*/) const override { return "cam01"; }
  [[nodiscard]] gvsp::Picture expose(std::uint32_t /*camera*/, std::uint64_t /*trigger*/,
                                     std::uint32_t /*slot*/) override {
    return {.pieces = {std::span<const std::uint8_t>(pixels_), {}, {}}};
  }

 private:
  std::array<std::uint8_t, std::size_t{kSensor.width} * kSensor.height> pixels_{};
};

}  // namespace

/// A conversation with one camera. Each step: the peer's number, what to do (a datagram of the
/// length that follows, an edge of Line1, or a wait), until the input ends.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string kXml = makeDeviceXml(kMaxPacketBytes);
  GreyScene scene;
  Counters counters;
  LatenessHistogram lateness;
  LossModel loss(0, 1);
  RigContext context{.scene = scene,
                     .counters = counters,
                     .lateness = lateness,
                     .loss = loss,
                     .wire_log = nullptr,
                     .link_bits_per_second = 1e9,
                     .max_packet_bytes = kMaxPacketBytes,
                     .xml = kXml};
  const auto camera = std::make_unique<Camera>(
      Identity{.number = 0, .address = 0x7f000001, .user_name = "cam01", .sensor = kSensor},
      kNoSocket, context);

  fuzz::Bytes bytes(data, size);
  rt::Timestamp now = rt::fromNs(1'000'000'000);
  std::uint64_t triggers = 0;
  while (!bytes.empty()) {
    const auto step = bytes.number<std::uint8_t>();
    now += std::chrono::milliseconds(1 + (step >> 4));
    switch (step & 3) {
      case 0:
      case 1: {
        sockaddr_in from{};
        from.sin_family = AF_INET;
        from.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        from.sin_port = htons(static_cast<std::uint16_t>(50000 + (step & 1)));
        const auto datagram = bytes.take(bytes.number<std::uint8_t>());
        camera->onControl(datagram, from, now, [](std::span<const std::uint8_t> answer) {
          fuzz::require(answer.size() >= gvcp::kHeaderBytes &&
                            answer.size() <= gvcp::kHeaderBytes + gvcp::kMaxPayloadBytes,
                        "an answer fits its datagram");
        });
        break;
      }
      case 2:
        camera->onLine1((step & 4) == 0, now, ++triggers);
        break;
      default:
        now += std::chrono::seconds(step >> 4);
        break;
    }
    camera->advance(now);
  }
  return 0;
}
