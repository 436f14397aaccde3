/// Frames over a real socket: what comes out of it is what the picture shows.
#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include <gtest/gtest.h>
#include <sys/socket.h>

#include "hal/emulated/rig/bytes.h"
#include "hal/emulated/rig/packet_sender.h"
#include "hal/emulated/rig/socket.h"

namespace {

using namespace emulator;  // NOLINT(google-build-using-namespace)

constexpr std::uint32_t kLoopback = 0x7f00'0001;
constexpr std::uint32_t kWidth = 320;
constexpr std::uint32_t kHeight = 256;

/// A picture of which every third row has three runs replaced, one across packets' ends.
class Overlaid {
 public:
  Overlaid() : below_(kWidth * kHeight) {
    for (std::size_t i = 0; i < below_.size(); ++i)
      below_[i] = static_cast<std::uint8_t>(i * 7 % 100);
    for (std::uint32_t y = 0; y < kHeight; y += 3) {
      for (const PixelRun run : {PixelRun{0, 1, 0}, {13, 60, 0}, {100, 220, 0}}) {
        runs_.push_back({y * kWidth + run.start, run.length, at()});
        for (std::uint32_t i = 0; i < run.length; ++i)
          above_.push_back(static_cast<std::uint8_t>(100 + (at() % 150)));
      }
    }
  }
  [[nodiscard]] gvsp::Picture picture() const {
    const std::span<const std::uint8_t> all(below_);
    return {.pieces = {all.first(1000), all.subspan(1000, 5000), all.subspan(6000)},
            .overlay = {.runs = runs_, .pixels = above_}};
  }
  [[nodiscard]] std::vector<std::uint8_t> seen() const {
    std::vector<std::uint8_t> pixels = below_;
    for (const PixelRun& run : runs_)
      std::copy_n(&above_[run.from], run.length, &pixels[run.start]);
    return pixels;
  }

 private:
  [[nodiscard]] std::uint32_t at() const { return static_cast<std::uint32_t>(above_.size()); }

  std::vector<std::uint8_t> below_;
  std::vector<std::uint8_t> above_;
  std::vector<PixelRun> runs_;
};

/// Sends packet by packet or by many, and puts together what arrives.
std::vector<std::uint8_t> sendAndReceive(const gvsp::Frame& frame, std::uint32_t at_once,
                                         PacketFaults& faults) {
  const auto from = bindUdp(kLoopback, 0, false);
  const auto to = bindUdp(kLoopback, 0, false);
  if (!from || !to) return {};
  sockaddr_in address{};
  socklen_t length = sizeof address;
  ::getsockname(to->get(), reinterpret_cast<sockaddr*>(&address), &length);

  PacketSender sender(from->get());
  std::vector<std::uint8_t> pixels(frame.picture.bytes());
  std::map<std::uint32_t, int> arrived;
  std::uint32_t next = 0;
  while (next < frame.packetCount()) {
    const auto outcome =
        sender.send(address, frame, next, std::min(at_once, frame.packetCount() - next), faults);
    EXPECT_EQ(outcome.os_errno, 0);
    if (outcome.packets == 0) break;
    next += outcome.packets;
    std::array<std::uint8_t, 10'000> packet{};
    for (;;) {
      const ssize_t bytes = ::recv(to->get(), packet.data(), packet.size(), 0);
      if (bytes < 0) break;
      const std::uint32_t id = loadBe32(&packet[4]) & 0xffffff;
      ++arrived[id];
      if (id == 0 || id == frame.packetCount() - 1) continue;
      std::copy_n(&packet[gvsp::kHeaderBytes], static_cast<std::size_t>(bytes) - gvsp::kHeaderBytes,
                  &pixels[std::size_t{id - 1} * frame.payload_per_packet]);
    }
  }
  EXPECT_EQ(arrived.size(), frame.packetCount());
  return pixels;
}

TEST(EmulatorPackets, CarryThePictureWithWhatIsLaidOverIt) {
  const Overlaid scene;
  LossModel nothing_lost(0, 1);
  for (const bool in_order : {true, false}) {
    PacketFaults faults(nothing_lost, 1);
    if (!in_order) faults.setDuplicate(0.3);
    for (const std::uint32_t payload : {500u, 1400u, 8000u}) {
      for (const std::uint32_t at_once : {1u, 7u, 1000u}) {
        const gvsp::Frame frame{.block_id = 1,
                                .width_px = kWidth,
                                .height_px = kHeight,
                                .payload_per_packet = payload,
                                .picture = scene.picture()};
        EXPECT_EQ(sendAndReceive(frame, at_once, faults), scene.seen())
            << "payload " << payload << ", " << at_once << " together, in order " << in_order;
      }
    }
  }
}

}  // namespace
