#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "hal/emulated/studio/moment_file.h"
#include "hal/emulated/studio/progress_bar.h"
#include "hal/emulated/studio/scene_cache.h"

namespace {

namespace fs = std::filesystem;
using emulator::studio::Patch;
using emulator::studio::SceneCache;

class StudioCache : public testing::Test {
 protected:
  void SetUp() override {
    root_ =
        fs::temp_directory_path() / ("kagami-studio-cache." + std::to_string(::getpid()) + "." +
                                     testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(root_);
  }
  void TearDown() override { fs::remove_all(root_); }

  /// The one file of that name, in whichever scene's folder.
  [[nodiscard]] fs::path find(const std::string& name) const {
    for (const auto& entry : fs::recursive_directory_iterator(root_)) {
      if (entry.path().filename() == name) return entry.path();
    }
    return {};
  }

  fs::path root_;
  const std::vector<std::byte> bytes_ = std::vector<std::byte>(1000, std::byte{42});
};

TEST_F(StudioCache, GivesBackWhatItWasGiven) {
  SceneCache(root_, "hall", 1 << 20).store("camera-0", bytes_);
  const SceneCache again(root_, "hall", 1 << 20);
  EXPECT_EQ(again.load("camera-0"), bytes_);
  EXPECT_FALSE(again.load("camera-1"));
}

TEST_F(StudioCache, KeepsScenesApart) {
  SceneCache(root_, "hall", 1 << 20).store("camera-0", bytes_);
  EXPECT_FALSE(SceneCache(root_, "another hall", 1 << 20).load("camera-0"));
}

TEST_F(StudioCache, DeletesADamagedFileAndSaysSo) {
  SceneCache cache(root_, "hall", 1 << 20);
  cache.store("camera-0", bytes_);
  const fs::path path = find("camera-0");
  ASSERT_FALSE(path.empty());
  {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(500);
    file.put('x');
  }
  testing::internal::CaptureStderr();
  EXPECT_FALSE(cache.load("camera-0"));
  EXPECT_NE(testing::internal::GetCapturedStderr().find("camera-0 is damaged"), std::string::npos);
  EXPECT_FALSE(fs::exists(path));
}

TEST_F(StudioCache, TakesAShortFileForDamaged) {
  SceneCache cache(root_, "hall", 1 << 20);
  cache.store("camera-0", bytes_);
  fs::resize_file(find("camera-0"), 700);
  testing::internal::CaptureStderr();
  EXPECT_FALSE(cache.load("camera-0"));
  EXPECT_FALSE(testing::internal::GetCapturedStderr().empty());
}

TEST_F(StudioCache, DropsTheSceneThatWasNotUsedForTheLongestTime) {
  for (const char* scene : {"first", "second", "third"}) {
    SceneCache(root_, scene, 10'000).store("camera-0", bytes_);
  }
  // "first" was used again since, "second" never.
  for (const auto& entry : fs::directory_iterator(root_)) {
    std::ifstream used(entry.path() / "used");
    std::string scene;
    used >> scene;
    const auto ago = std::chrono::hours(scene == "second" ? 3 : 1);
    fs::last_write_time(entry.path() / "used", fs::file_time_type::clock::now() - ago);
  }
  SceneCache(root_, "fourth", 3'500).store("camera-0", bytes_);
  EXPECT_TRUE(SceneCache(root_, "first", 10'000).load("camera-0"));
  EXPECT_FALSE(SceneCache(root_, "second", 10'000).load("camera-0"));
  EXPECT_TRUE(SceneCache(root_, "third", 10'000).load("camera-0"));
  EXPECT_TRUE(SceneCache(root_, "fourth", 10'000).load("camera-0"));
}

TEST_F(StudioCache, StopsAtItsLimitAndSaysSoOnce) {
  SceneCache cache(root_, "hall", 1500);
  testing::internal::CaptureStderr();
  cache.store("camera-0", bytes_);
  cache.store("camera-1", bytes_);
  cache.store("camera-2", bytes_);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("limit"), std::string::npos) << said;
  EXPECT_EQ(std::ranges::count(said, '\n'), 1) << said;
  EXPECT_FALSE(find("camera-0").empty());
  EXPECT_TRUE(find("camera-1").empty());
}

TEST_F(StudioCache, GoesOnWithoutAFolder) {
  {
    std::ofstream(root_) << "a file where the folder should be";
  }
  testing::internal::CaptureStderr();
  SceneCache cache(root_, "hall", 1 << 20);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("is not kept"), std::string::npos);
  cache.store("camera-0", bytes_);
  EXPECT_FALSE(cache.load("camera-0"));
}

TEST_F(StudioCache, SaysThatTheDiskIsFull) {
  const fs::path full = "/dev/full";  // every write to it finds no room
  if (!fs::exists(full)) GTEST_SKIP() << "this machine has no /dev/full";
  SceneCache cache(root_, "hall", 1 << 20);
  fs::create_symlink(full, find("used").parent_path() / "camera-0.part");
  testing::internal::CaptureStderr();
  cache.store("camera-0", bytes_);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("cannot write"), std::string::npos) << said;
  EXPECT_TRUE(find("camera-0").empty());
}

std::vector<std::vector<Patch>> someMoments() {
  Patch patch{.runs = {{3, 2, 0}, {10, 3, 2}}, .pixels = {1, 2, 3, 4, 5}};
  return {{patch, Patch{}}, {Patch{}, patch}};
}

TEST(StudioMoments, ComeBackFromTheirFile) {
  const auto moments = someMoments();
  const auto back =
      emulator::studio::readMoments(emulator::studio::writeMoments(moments), 2, 2, {8, 4});
  ASSERT_TRUE(back);
  EXPECT_EQ((*back)[0][0].pixels, moments[0][0].pixels);
  EXPECT_EQ((*back)[1][1].runs[1].start, 10u);
}

TEST(StudioMoments, AreRefusedWhenTheyAreOthers) {
  auto bytes = emulator::studio::writeMoments(someMoments());
  EXPECT_FALSE(emulator::studio::readMoments(bytes, 3, 2, {8, 4})) << "more moments than there are";
  EXPECT_FALSE(emulator::studio::readMoments(bytes, 1, 2, {8, 4})) << "fewer";
  EXPECT_FALSE(emulator::studio::readMoments(bytes, 2, 2, {4, 2}))
      << "pictures too small for the runs";
  bytes.pop_back();
  EXPECT_FALSE(emulator::studio::readMoments(bytes, 2, 2, {8, 4})) << "cut short";
}

TEST(StudioMoments, AreRefusedWhenRunsOverlapOrPointElsewhere) {
  for (const std::vector<emulator::PixelRun>& runs :
       {std::vector<emulator::PixelRun>{{3, 3, 0}, {5, 2, 3}}, {{3, 3, 0}, {10, 2, 2}}}) {
    const std::vector<std::vector<Patch>> moments = {{{.runs = runs, .pixels = {1, 2, 3, 4, 5}}}};
    EXPECT_FALSE(
        emulator::studio::readMoments(emulator::studio::writeMoments(moments), 1, 1, {8, 4}));
  }
}

TEST(StudioPatch, CountsItsRunsAsTheyAreMade) {
  Patch patch;
  emulator::studio::RunMaker maker(patch.runs);
  maker.beginRow();
  EXPECT_EQ(maker.add(100), 0u);
  EXPECT_EQ(maker.add(103), 2u) << "two pixels between them belong to the run";
  EXPECT_EQ(maker.add(150), 0u);
  maker.beginRow();
  EXPECT_EQ(maker.add(151), 0u) << "another row";
  ASSERT_EQ(patch.runs.size(), 3u);
  EXPECT_TRUE(emulator::studio::fit(patch.runs, 152, 6));
  EXPECT_FALSE(emulator::studio::fit(patch.runs, 151, 6));
  EXPECT_FALSE(emulator::studio::fit(patch.runs, 152, 7));
}

TEST(StudioProgress, FillsItsBar) {
  EXPECT_EQ(emulator::studio::progressLine(0.5, "light"),
            "[###############---------------]  50 % light");
  EXPECT_EQ(emulator::studio::progressLine(2, "ready"),
            "[##############################] 100 % ready");
}

}  // namespace
