#include <algorithm>
#include <vector>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "hal/emulated/rig/bytes.h"
#include "hal/emulated/rig/camera.h"
#include "hal/emulated/rig/device_xml.h"
#include "hal/emulated/rig/socket.h"

namespace {

using namespace emulator;  // NOLINT(google-build-using-namespace)

class GreyScene final : public Scene {
 public:
  std::uint32_t cameraCount() const override { return 1; }
  SizePx sensorSize(std::uint32_t) const override { return {64, 32}; }
  std::string cameraName(std::uint32_t) const override { return "cam01"; }
  gvsp::Picture expose(std::uint32_t, std::uint64_t, std::uint32_t) override {
    return {{pixels_, {}, {}}};
  }

 private:
  std::vector<std::uint8_t> pixels_ = std::vector<std::uint8_t>(64 * 32, 128);
};

const std::string kXml = makeDeviceXml(9000);

/// A camera that sends to nowhere in particular.
struct Bench {
  GreyScene scene;
  Counters counters;
  LatenessHistogram lateness;
  LossModel loss{0, 1};
  RigContext context{scene, counters, lateness, loss, nullptr, 1e9, 9000, kXml};
  UniqueFd stream = bindUdp(INADDR_LOOPBACK, 0, false).value_or(UniqueFd());
  Camera camera{{.address = INADDR_LOOPBACK, .sensor = {64, 32}}, stream.get(), context};
  rt::Timestamp now = rt::now();

  std::size_t say(const std::vector<std::uint8_t>& datagram) {
    sockaddr_in from{};
    from.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    from.sin_port = htons(4000);
    std::size_t longest = 0;
    camera.onControl(datagram, from, now,
                     [&](auto answer) { longest = std::max(longest, answer.size()); });
    now += std::chrono::microseconds(100);
    camera.advance(now);
    return longest;
  }
};

std::vector<std::uint8_t> command(std::uint16_t code, const std::vector<std::uint8_t>& payload) {
  std::vector<std::uint8_t> bytes(8 + payload.size());
  bytes[0] = 0x42;
  bytes[1] = 1;  // wants an answer
  storeBe16(&bytes[2], code);
  storeBe16(&bytes[4], static_cast<std::uint16_t>(payload.size()));
  std::ranges::copy(payload, bytes.begin() + 8);
  return bytes;
}

RC_GTEST_PROP(GvcpParse, SurvivesAnyBytes, (const std::vector<std::uint8_t>& bytes)) {
  const auto parsed = gvcp::parse(bytes);
  RC_ASSERT(!parsed || (bytes.size() >= gvcp::kHeaderBytes && bytes[0] == 0x42));
}

RC_GTEST_PROP(Camera, AnswersAnyPayloadOfAnyCommandWithinADatagram, ()) {
  Bench bench;
  bench.say(command(0x0082, {0, 0, 0x0a, 0, 0, 0, 0, 2}));  // takes control: writes count
  const auto rounds = *rc::gen::inRange(1, 12);
  for (int i = 0; i < rounds; ++i) {
    const auto code = *rc::gen::element<std::uint16_t>(0x0002, 0x0004, 0x0040, 0x0080, 0x0082,
                                                       0x0084, 0x0086, 0x0100);
    const auto payload = *rc::gen::arbitrary<std::vector<std::uint8_t>>();
    RC_ASSERT(bench.say(command(code, payload)) <= gvcp::kHeaderBytes + gvcp::kMaxPayloadBytes);
  }
}

RC_GTEST_PROP(Camera, SurvivesAnyWriteToAnyFeature, ()) {
  Bench bench;
  bench.say(command(0x0082, {0, 0, 0x0a, 0, 0, 0, 0, 2}));
  const auto rounds = *rc::gen::inRange(1, 40);
  for (int i = 0; i < rounds; ++i) {
    const auto all = features();
    const auto& feature = all[*rc::gen::inRange<std::size_t>(0, all.size())];
    std::vector<std::uint8_t> pair(8);
    storeBe32(pair.data(), feature.address);
    storeBe32(&pair[4], *rc::gen::oneOf(rc::gen::inRange<std::uint32_t>(0, 2000),
                                        rc::gen::arbitrary<std::uint32_t>()));
    RC_ASSERT(bench.say(command(0x0082, pair)) == gvcp::kHeaderBytes + 4);
  }
}

}  // namespace
