#pragma once

#include <cstdint>
#include <limits>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/conformance/display_fixture.h"

// What every backend of hal::Display must do, whatever its screen. One file of a program includes
// this and says for which backends.
namespace test {

TEST_P(DisplayConformance, HasAModeAndNamesWhatDraws) {
  const hal::DisplayMode mode = display_->mode();
  EXPECT_GT(mode.width_px, 0U);
  EXPECT_GT(mode.height_px, 0U);
  EXPECT_GT(mode.refresh_hz, 0.0);
  EXPECT_FALSE(display_->renderer().empty());
}

TEST_P(DisplayConformance, NothingFlipsBeforeACommit) {
  EXPECT_FALSE(display_->tryPopFlip());
  renderOrFail();
  EXPECT_FALSE(display_->tryPopFlip());
}

TEST_P(DisplayConformance, RenderStampsItsStagesInOrder) {
  const rt::Timestamp before = rt::now();
  const auto instants = display_->render(scene());
  ASSERT_TRUE(instants);
  EXPECT_LE(before, instants->warp_submit);
  EXPECT_LE(instants->warp_submit, instants->upload_end);
  EXPECT_LE(instants->upload_end, instants->warp_end);
  EXPECT_LE(instants->warp_end, rt::now());
}

TEST_P(DisplayConformance, EveryCommitFlipsOnceInOrderAndLater) {
  constexpr std::uint64_t kPictures = 5;
  rt::Timestamp last_flip;
  std::uint64_t last_vblank = 0;
  for (std::uint64_t id = 1; id <= kPictures; ++id) {
    renderOrFail();
    const rt::Timestamp committed = commitWhenReady(id);
    const auto flip = waitFlip();
    ASSERT_TRUE(flip);
    EXPECT_EQ(flip->picture_id, id);
    EXPECT_GT(flip->page_flip, committed);
    EXPECT_GT(flip->page_flip, last_flip);
    EXPECT_TRUE(id == 1 || flip->vblank > last_vblank);
    last_flip = flip->page_flip;
    last_vblank = flip->vblank;
  }
  EXPECT_FALSE(display_->tryPopFlip());
}

TEST_P(DisplayConformance, FlipsNobodyAskedForWaitInOrder) {
  for (std::uint64_t id = 1; id <= 4; ++id) {
    renderOrFail();
    commitWhenReady(id);
  }
  for (std::uint64_t id = 1; id <= 4; ++id) {
    const auto flip = waitFlip();
    ASSERT_TRUE(flip);
    EXPECT_EQ(flip->picture_id, id);
  }
}

TEST_P(DisplayConformance, ACommitBeforeTheLastFlipIsBusyAndSucceedsLater) {
  // A vblank may fall between two commits, so it may take more than one try to meet it.
  std::uint64_t id = 0;
  bool met_busy = false;
  for (int attempt = 0; attempt < 100 && !met_busy; ++attempt) {
    renderOrFail();
    commitWhenReady(++id);
    renderOrFail();
    const auto second = display_->commit(++id);
    if (second) continue;
    EXPECT_EQ(second.error().code, rt::Errc::kBusy);
    met_busy = true;
    commitWhenReady(id);  // the drawn picture was not lost
  }
  EXPECT_TRUE(met_busy);
  std::uint64_t expected = 1;
  while (expected <= id) {
    const auto flip = waitFlip();
    ASSERT_TRUE(flip);
    EXPECT_EQ(flip->picture_id, expected++);
  }
}

TEST_P(DisplayConformance, ACommitWithoutAPictureIsRefusedAndHarmless) {
  EXPECT_FALSE(display_->commit(1));
  renderOrFail();
  commitWhenReady(2);
  const auto flip = waitFlip();
  ASSERT_TRUE(flip);
  EXPECT_EQ(flip->picture_id, 2U);
}

TEST_P(DisplayConformance, RendersWithoutAPlanAndWithoutText) {
  ASSERT_TRUE(display_->render({}));
  commitWhenReady(1);
  EXPECT_TRUE(waitFlip());
}

TEST_P(DisplayConformance, TakesEveryPixelFormatAndAChangeOfSize) {
  using enum hal::PixelFormat;
  std::vector<std::byte> other(std::size_t{32} * 80, std::byte{50});
  for (const auto format : {kBayerRG8, kBayerGB8, kBayerGR8, kBayerBG8, kMono8}) {
    plan_.source = {other.data(), 32, 80, format};
    ASSERT_TRUE(display_->render(scene()));
    plan_.source = {pixels_.data(), 64, 48, format};
    ASSERT_TRUE(display_->render(scene()));
  }
}

TEST_P(DisplayConformance, SurvivesAPlanOfNumbersThatAreNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity, 0.0}) {
    plan_.H_camera_display.fill(bad);
    ASSERT_TRUE(display_->render(scene()));
  }
  plan_.lens = {.fx_px = 0, .fy_px = nan, .max_radius = infinity};
  ASSERT_TRUE(display_->render(scene()));
}

TEST_P(DisplayConformance, TakesTextThatIsNoText) {
  write(std::string(200, '\xff'));  // no utf-8
  ASSERT_TRUE(display_->render(scene()));
  write(std::string(200, 'W'));  // wider than any screen
  ASSERT_TRUE(display_->render(scene()));
  write(std::string("live\0\n\t\x1b", 8));
  ASSERT_TRUE(display_->render(scene()));
}

TEST_P(DisplayConformance, GoesFromThreadToThreadByDetach) {
  for (std::uint64_t id = 1; id <= 2; ++id) {
    std::jthread render_thread([&] {
      renderOrFail();
      commitWhenReady(id);
      EXPECT_TRUE(waitFlip());
      display_->detach();
    });
  }
  renderOrFail();
}

TEST_P(DisplayConformance, MayBeDestroyedAfterAThreadThatDidNotDetach) {
  std::jthread([&] { renderOrFail(); }).join();
  display_.reset();
}

}  // namespace test
