#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "hal/emulated/rig/bytes.h"
#include "hal/emulated/rig/frame_source.h"
#include "hal/emulated/rig/gvsp.h"
#include "hal/emulated/rig/pacing.h"
#include "hal/emulated/rig/sensor.h"

namespace {

using namespace emulator;  // NOLINT(google-build-using-namespace)
using namespace std::chrono_literals;

TEST(GvspFrame, CountsLeaderPayloadAndTrailer) {
  const std::vector<std::uint8_t> pixels(1000);
  gvsp::Frame frame{.payload_per_packet = 400, .picture = {{pixels, {}, {}}}};
  EXPECT_EQ(frame.packetCount(), 5u);
  frame.payload_per_packet = 500;
  EXPECT_EQ(frame.packetCount(), 4u);
}

TEST(GvspLeader, DescribesThePicture) {
  const gvsp::Frame frame{.block_id = 0x0102,
                          .timestamp = 0x1'0000'0002,
                          .width_px = 1280,
                          .height_px = 1024,
                          .offset_x_px = 8,
                          .offset_y_px = 6,
                          .pixel_format = gvsp::kPixelBayerRG8,
                          .payload_per_packet = 8964,
                          .picture = {}};
  const auto leader = gvsp::encodeLeader(frame);
  EXPECT_EQ(loadBe16(&leader[0]), 0);
  EXPECT_EQ(loadBe16(&leader[2]), 0x0102);
  EXPECT_EQ(loadBe32(&leader[4]), 1u << 24);
  EXPECT_EQ(loadBe16(&leader[10]), 1);
  EXPECT_EQ(loadBe32(&leader[12]), 1u);
  EXPECT_EQ(loadBe32(&leader[16]), 2u);
  EXPECT_EQ(loadBe32(&leader[20]), gvsp::kPixelBayerRG8);
  EXPECT_EQ(loadBe32(&leader[24]), 1280u);
  EXPECT_EQ(loadBe32(&leader[28]), 1024u);
  EXPECT_EQ(loadBe32(&leader[32]), 8u);
  EXPECT_EQ(loadBe32(&leader[36]), 6u);
}

TEST(GvspPackets, CarryTheirKindAndNumber) {
  EXPECT_EQ(loadBe32(&gvsp::encodePayloadHeader(1, 77)[4]), 3u << 24 | 77);
  const auto gone = gvsp::encodeUnavailable(9, 5);
  EXPECT_EQ(loadBe16(&gone[0]), 0x800c);
  EXPECT_EQ(loadBe16(&gone[2]), 9);
  const gvsp::Frame empty{.block_id = 3, .height_px = 2, .payload_per_packet = 100, .picture = {}};
  EXPECT_EQ(loadBe32(&gvsp::encodeTrailer(empty)[4]), 2u << 24 | 1);
}

TEST(Pacing, SendsTheLeaderAtOnceAndEveryGroupWhenItsLastPacketLeft) {
  // 962 + 38 bytes at 8 Mb/s: 1 ms per packet; groups may last 1 ms, so they hold one packet.
  Pacing pacing(rt::fromNs(0), {.bits_per_second = 8e6, .packet_bytes = 962}, 3, 10);
  EXPECT_EQ(pacing.next().at, rt::fromNs(0));
  EXPECT_EQ(pacing.next().count, 1u);
  pacing.advance(1);
  EXPECT_EQ(pacing.next().first, 1u);
  EXPECT_EQ(pacing.next().at, rt::fromNs(2'000'000));
  pacing.advance(1);
  EXPECT_EQ(pacing.next().at, rt::fromNs(3'000'000));
  EXPECT_EQ(pacing.scheduledEnd(), rt::fromNs(3'000'000));
  pacing.advance(1);
  EXPECT_TRUE(pacing.done());
}

TEST(Pacing, AFullFrameTakesWhatAGigabitLinkTakes) {
  constexpr std::uint32_t kPackets = (1280 * 1024 + 8963) / 8964 + 2;
  const Pacing plain(rt::fromNs(0), {.packet_bytes = 9000}, kPackets, 7);
  EXPECT_NEAR(static_cast<double>(rt::toNs(plain.scheduledEnd())), 10.75e6, 0.15e6);
  const Pacing delayed(rt::fromNs(0), {.packet_bytes = 9000, .packet_delay = 80us}, kPackets, 7);
  EXPECT_EQ(delayed.scheduledEnd() - plain.scheduledEnd(), 80us * kPackets);
}

TEST(Sensor, ExposesFromTheEdgeForTheSetTime) {
  const auto exposure =
      tryExpose(5, rt::fromNs(1'000), {.trigger_delay = 10us, .exposure = 1ms}, false, {});
  ASSERT_TRUE(exposure);
  EXPECT_EQ(exposure->trigger, 5u);
  EXPECT_EQ(exposure->start, rt::fromNs(11'000));
  EXPECT_EQ(exposure->end, rt::fromNs(1'011'000));
}

TEST(Sensor, CannotFollowAnEdgeWhileItExposes) {
  EXPECT_FALSE(tryExpose(1, rt::fromNs(0), {.exposure = 1ms}, true, {}));
}

TEST(Sensor, MayExposeWhileTheLinkSendsButNotReadOutBeforeItIsFree) {
  const ExposureTiming timing{.exposure = 1ms};
  EXPECT_TRUE(tryExpose(1, rt::fromNs(0), timing, false, rt::fromNs(1'000'000)));
  EXPECT_FALSE(tryExpose(1, rt::fromNs(0), timing, false, rt::fromNs(1'000'001)));
}

/// 4 x 4 pixels that count upwards, in three pieces.
class CountingScene final : public Scene {
 public:
  std::uint32_t cameraCount() const override { return 1; }
  SizePx sensorSize(std::uint32_t) const override { return {4, 4}; }
  std::string cameraName(std::uint32_t) const override { return "cam01"; }
  gvsp::Picture expose(std::uint32_t, std::uint64_t, std::uint32_t) override {
    const std::span<const std::uint8_t> all(pixels_);
    return {{all.first(5), all.subspan(5, 6), all.subspan(11)}};
  }

 private:
  std::array<std::uint8_t, 16> pixels_ = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
};

/// The counting scene with pixels 2 to 6 and 12 replaced by 102 to 106 and 112.
gvsp::Picture overlaid(CountingScene& scene) {
  static constexpr std::array<PixelRun, 2> kRuns = {PixelRun{2, 5, 0}, PixelRun{12, 1, 5}};
  static constexpr std::array<std::uint8_t, 6> kPixels = {102, 103, 104, 105, 106, 112};
  gvsp::Picture picture = scene.expose(0, 1, 0);
  picture.overlay = {.runs = kRuns, .pixels = kPixels};
  return picture;
}

TEST(Overlay, ReplacesWhatAPartOfThePictureHasOfIt) {
  CountingScene scene;
  const gvsp::Picture picture = overlaid(scene);
  const std::vector<std::uint8_t> whole = {0, 1, 102, 103, 104, 105, 106, 7,
                                           8, 9, 10,  11,  112, 13,  14,  15};
  for (std::size_t first = 0; first < whole.size(); ++first) {
    for (std::size_t end = first + 1; end <= whole.size(); ++end) {
      std::vector<std::uint8_t> part(end - first);
      picture.copyTo(part, first);
      const std::vector<std::uint8_t> wanted(&whole[first], &whole[first] + part.size());
      EXPECT_EQ(part, wanted) << first << " to " << end;
      const bool replaced = std::ranges::any_of(part, [](std::uint8_t v) { return v > 100; });
      EXPECT_EQ(picture.overlay.touches(first, part.size()), replaced) << first << " to " << end;
    }
  }
}

TEST(FrameSource, PassesTheWholeSensorOnWithoutACopy) {
  CountingScene scene;
  FrameSource source(scene, 0);
  source.prepare({.sensor = {4, 4}, .size = {4, 4}, .pixel_format = gvsp::kPixelBayerRG8});
  EXPECT_EQ(source.expose(1, 0).pieces[1].data(), scene.expose(0, 1, 0).pieces[1].data());
}

TEST(FrameSource, CutsTheRegionOut) {
  CountingScene scene;
  FrameSource source(scene, 0);
  source.prepare({.sensor = {4, 4},
                  .offset_x_px = 2,
                  .offset_y_px = 1,
                  .size = {2, 2},
                  .pixel_format = gvsp::kPixelBayerRG8});
  const auto picture = source.expose(1, 0);
  EXPECT_EQ(std::vector(picture.pieces[0].begin(), picture.pieces[0].end()),
            (std::vector<std::uint8_t>{6, 7, 10, 11}));
}

TEST(FrameSource, MakesGreyOfFourNeighbours) {
  CountingScene scene;
  FrameSource source(scene, 0);
  source.prepare({.sensor = {4, 4}, .size = {4, 4}, .pixel_format = gvsp::kPixelMono8});
  const auto picture = source.expose(1, 0);
  EXPECT_EQ(picture.pieces[0][0], (0 + 1 + 4 + 5 + 2) / 4);
  EXPECT_EQ(picture.pieces[0][15], (15 + 14 + 11 + 10 + 2) / 4);
}

}  // namespace
