#include "appliance/overlay/overlay_loop.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "appliance/overlay/status_overlay.h"

namespace {

using appliance::addStatusLine;
using appliance::Mode;
using appliance::OverlayBoard;
using appliance::OverlayLoop;
using appliance::OverlaySubject;

/// Every letter is half as wide as it is high.
class PlainTypesetter final : public hal::Typesetter {
 public:
  struct Line {
    std::string text;
    hal::TextBox box;
  };

  void begin(hal::Overlay& overlay) override { overlay.count = overlay.refused = 0; }
  void finish(hal::Overlay& overlay) override { overlay.generation = ++overlays; }
  float set(hal::Overlay& overlay, std::string_view text, const hal::TextBox& box,
            hal::OverlayColour /*colour*/) override {
    lines.push_back({std::string(text), box});
    overlay.add({.kind = hal::OverlayItem::Kind::kGlyph});
    return std::min(box.width_px, widthPx(text, box.size_px));
  }
  float widthPx(std::string_view text, float size_px) override {
    return static_cast<float>(text.size()) * size_px / 2;
  }
  float capHeightPx(float size_px) override { return 0.7F * size_px; }
  std::string takeWarning() override { return std::exchange(warning, {}); }

  std::vector<Line> lines;
  std::uint64_t overlays = 0;
  std::string warning;
};

class StatusOverlay : public testing::Test {
 protected:
  PlainTypesetter typesetter_;
  std::unique_ptr<hal::Overlay> overlay_ = std::make_unique<hal::Overlay>();
};

TEST_F(StatusOverlay, TheTypeFollowsTheShorterSide) {
  addStatusLine({.text = "LIVE"}, 1'920, 1'080, typesetter_, *overlay_);
  addStatusLine({.text = "LIVE"}, 1'080, 1'920, typesetter_, *overlay_);
  ASSERT_EQ(typesetter_.lines.size(), 2U);
  EXPECT_FLOAT_EQ(typesetter_.lines[0].box.size_px, 60);
  EXPECT_FLOAT_EQ(typesetter_.lines[1].box.size_px, 60);
  EXPECT_GT(typesetter_.lines[1].box.baseline_px, 1'800);  // at the foot all the same
}

TEST_F(StatusOverlay, WhatIsTooLongIsDividedBetweenStatements) {
  addStatusLine({.text = "LIVE   view 7/20   camera 7 lost: showing 8"}, 720, 1'280, typesetter_,
                *overlay_);
  ASSERT_EQ(typesetter_.lines.size(), 2U);
  EXPECT_EQ(typesetter_.lines[0].text, "LIVE   view 7/20");
  EXPECT_EQ(typesetter_.lines[1].text, "camera 7 lost: showing 8");
  EXPECT_GT(typesetter_.lines[1].box.baseline_px, typesetter_.lines[0].box.baseline_px);
}

TEST_F(StatusOverlay, AStatementThatIsTooLongIsDividedBehindItsColon) {
  addStatusLine({.text = "LIVE   camera 7 lost: showing its last picture"}, 720, 1'280, typesetter_,
                *overlay_);
  ASSERT_EQ(typesetter_.lines.size(), 2U);
  EXPECT_EQ(typesetter_.lines[0].text, "LIVE   camera 7 lost:");
  EXPECT_EQ(typesetter_.lines[1].text, "showing its last picture");
}

TEST_F(StatusOverlay, AStatementIsNeverWiderThanThePicture) {
  addStatusLine({.text = std::string(200, 'W')}, 720, 1'280, typesetter_, *overlay_);
  ASSERT_EQ(typesetter_.lines.size(), 1U);
  EXPECT_LT(typesetter_.lines[0].box.x_px + typesetter_.lines[0].box.width_px, 720);
  EXPECT_LT(overlay_->items[0].x_px + overlay_->items[0].width_px, 720);  // its plate
}

TEST_F(StatusOverlay, WithoutATextNothingIsDrawn) {
  addStatusLine({}, 720, 1'280, typesetter_, *overlay_);
  EXPECT_EQ(overlay_->count, 0U);
}

/// A loop on its own thread, and what it has put on the board.
class OverlayLoopTest : public testing::Test {
 protected:
  OverlayLoopTest() : thread_([this](const std::stop_token& stop) { loop_.run(stop); }) {}
  ~OverlayLoopTest() override {
    thread_.request_stop();
    board_->subject_changed.ring();
  }

  void say(const OverlaySubject& subject) {
    board_->subject.publish(subject);
    board_->subject_changed.ring();
  }
  bool waitForOverlay(std::uint64_t generation) {
    const rt::Timestamp patience = rt::now() + std::chrono::seconds(20);
    while (board_->overlay.latest().generation < generation && rt::now() < patience) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return board_->overlay.latest().generation == generation;
  }
  static OverlaySubject live(std::uint64_t trigger) {
    return {.shot = {.trigger = trigger}, .cameras = 20, .width_px = 1'280, .height_px = 720};
  }

  std::unique_ptr<OverlayBoard> board_ = std::make_unique<OverlayBoard>();
  PlainTypesetter typesetter_;
  OverlayLoop loop_{*board_, typesetter_};
  std::jthread thread_;
};

TEST_F(OverlayLoopTest, AChangedTextOrPictureSizeIsANewOverlay) {
  say(live(1));
  EXPECT_TRUE(waitForOverlay(1));
  OverlaySubject frozen = live(1);
  frozen.shot.mode = Mode::kFrozen;
  say(frozen);
  EXPECT_TRUE(waitForOverlay(2));
  frozen.width_px = 640;
  say(frozen);
  EXPECT_TRUE(waitForOverlay(3));
}

TEST_F(OverlayLoopTest, ANewMomentWithTheSameTextIsNone) {
  say(live(1));
  EXPECT_TRUE(waitForOverlay(1));
  say(live(2));
  OverlaySubject other = live(3);
  other.shot.camera_wanted = other.shot.camera_shown = 1;
  say(other);
  EXPECT_TRUE(waitForOverlay(2));
}

TEST_F(OverlayLoopTest, WhatTheTextLacksIsKeptForWhoeverAsks) {
  EXPECT_EQ(loop_.warning(), "");
  typesetter_.warning = "no font";
  say(live(1));
  EXPECT_TRUE(waitForOverlay(1));
  const rt::Timestamp patience = rt::now() + std::chrono::seconds(20);
  while (loop_.warning().empty() && rt::now() < patience) std::this_thread::yield();
  EXPECT_EQ(loop_.warning(), "no font");
}

}  // namespace
