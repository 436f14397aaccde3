#include <atomic>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "appliance/geometry/rig_shelf.h"

namespace {

using appliance::checkReplaces;
using appliance::Rig;
using appliance::RigCamera;
using appliance::RigPin;
using appliance::RigShelf;
using testing::HasSubstr;

/// A rig whose every number says which one it is.
Rig rigOf(double mark, std::size_t cameras = 20) {
  Rig rig;
  rig.target_m = {mark, mark, mark};
  rig.reference_focal_px = mark;
  for (std::size_t i = 0; i < cameras; ++i) {
    RigCamera camera;
    camera.name = "cam" + std::to_string(i + 1);
    camera.width_px = 1280;
    camera.height_px = 1024;
    camera.lens.fx_px = mark;
    camera.t_cam_rig_m = {mark, mark, mark};
    rig.cameras.push_back(std::move(camera));
  }
  return rig;
}

bool isOne(const Rig& rig, double mark) {
  bool one = rig.reference_focal_px == mark && rig.target_m.z() == mark;
  for (const RigCamera& camera : rig.cameras)
    one = one && camera.lens.fx_px == mark && camera.t_cam_rig_m.x() == mark;
  return one && rig.cameras.size() == 20;
}

TEST(RigShelf, GivesTheRigThatWasPutLast) {
  RigShelf shelf(rigOf(1));
  EXPECT_EQ(shelf.newest().revision(), 1u);
  EXPECT_TRUE(isOne(*shelf.newest(), 1));
  ASSERT_EQ(shelf.put(rigOf(2)), 2u);
  EXPECT_EQ(shelf.revision(), 2u);
  EXPECT_TRUE(isOne(*shelf.newest(), 2));
}

TEST(RigShelf, LeavesAPinnedRigAsItWas) {
  RigShelf shelf(rigOf(1));
  const RigPin pin = shelf.newest();
  for (int i = 2; i < 100; ++i) ASSERT_TRUE(shelf.put(rigOf(i)));
  EXPECT_TRUE(isOne(*pin, 1));
  EXPECT_EQ(pin.revision(), 1u);
  EXPECT_EQ(shelf.revision(), 99u);
}

TEST(RigShelf, RefusesWhileReadersHoldEverySlotAndGoesOnAfterwards) {
  RigShelf shelf(rigOf(1));
  std::vector<RigPin> pins;
  for (std::uint32_t i = 0; i < RigShelf::kMostPins; ++i) {
    pins.push_back(shelf.newest());
    ASSERT_TRUE(shelf.put(rigOf(i + 2))) << i;
  }
  pins.push_back(shelf.newest());
  ASSERT_TRUE(shelf.put(rigOf(100)));  // the last free slot
  const auto refused = shelf.put(rigOf(101));
  ASSERT_FALSE(refused);
  EXPECT_THAT(textOf(refused.error()), HasSubstr("in use"));
  EXPECT_TRUE(isOne(*shelf.newest(), 100));
  pins.clear();
  EXPECT_TRUE(shelf.put(rigOf(102)));
  EXPECT_TRUE(isOne(*shelf.newest(), 102));
}

TEST(RigShelf, RefusesARigThatDoesNotFitTheRunningCameras) {
  RigShelf shelf(rigOf(1));
  EXPECT_EQ(textOf(shelf.put(rigOf(2, 19)).error()),
            "this rig has 19 cameras, 20 are running: restart kagamid with this rig");
  Rig renamed = rigOf(2);
  std::swap(renamed.cameras[3].name, renamed.cameras[4].name);
  EXPECT_THAT(textOf(shelf.put(renamed).error()),
              HasSubstr("camera 4 is called \"cam5\" in this rig and \"cam4\" in the running one"));
  Rig smaller = rigOf(2);
  smaller.cameras[19].height_px = 720;
  EXPECT_THAT(textOf(shelf.put(smaller).error()),
              HasSubstr("camera 20 sends 1280x1024 pixels, this rig says 1280x720"));
  Rig grey = rigOf(2);
  grey.cameras[0].pixel_format = hal::PixelFormat::kMono8;
  EXPECT_THAT(textOf(shelf.put(grey).error()),
              HasSubstr("camera 1 sends BayerRG8, this rig says Mono8"));
  EXPECT_TRUE(isOne(*shelf.newest(), 1));
  EXPECT_EQ(shelf.revision(), 1u);
}

TEST(RigShelf, IsNeverReadHalfSwapped) {
  constexpr int kSwaps = 1000;
  RigShelf shelf(rigOf(1));
  std::atomic<bool> swapped{false};
  std::atomic<int> readers{0};
  std::atomic<int> mixed{0};
  const auto read = [&] {
    ++readers;
    std::uint64_t last = 0;
    while (!swapped.load()) {
      const RigPin rig = shelf.newest();
      if (!isOne(*rig, static_cast<double>(rig.revision())) || rig.revision() < last) ++mixed;
      last = rig.revision();
    }
  };
  std::jthread first(read);
  std::jthread second(read);
  while (readers.load() < 2) std::this_thread::yield();
  for (int i = 2; i <= kSwaps; ++i) {
    const auto put = shelf.put(rigOf(i));
    EXPECT_EQ(put, static_cast<std::uint64_t>(i));
    std::this_thread::yield();
  }
  swapped.store(true);
  first.join();
  second.join();
  EXPECT_EQ(mixed.load(), 0);
  EXPECT_EQ(shelf.revision(), static_cast<std::uint64_t>(kSwaps));
}

}  // namespace
