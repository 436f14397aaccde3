// A screen that goes, comes back, is another one or belongs to another program: the picture returns
// by itself.

#include <cstdio>
#include <filesystem>
#include <string>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <xf86drm.h>

#include "appliance/status/screen_text.h"
#include "tests/kernel/support/kms_viewer.h"
#include "tests/kernel/support/other_screen.h"
#include "tests/kernel/support/vkms.h"
#include "ui-kms/kms/connector.h"
#include "ui-kms/kms/framebuffer.h"
#include "ui-kms/kms/output.h"

namespace test {
namespace {

using hal::ScreenState;
using testing::HasSubstr;

const std::string kCard = "/dev/dri/card0";
constexpr int kTimes = 20;

std::string messageOf(const ui::KmsDisplay& display) {
  return textOf(appliance::screenPhrase(display.screen()));
}

/// Another program with the same card.
class OtherProgram {
 public:
  explicit OtherProgram(const std::string& card) : fd_(::open(card.c_str(), O_RDWR | O_CLOEXEC)) {}

  [[nodiscard]] bool takeMaster() { return drmSetMaster(fd_.get()) == 0; }
  void dropMaster() { drmDropMaster(fd_.get()); }
  [[nodiscard]] bool master() const { return drmIsMaster(fd_.get()) != 0; }

  /// Scans out a grey picture in the screen's own favourite mode.
  [[nodiscard]] bool showGrey() {
    drmSetClientCap(fd_.get(), DRM_CLIENT_CAP_ATOMIC, 1);
    auto connector = ui::kms::findConnector(fd_.get(), ui::kms::Probe::kKnown);
    if (!connector) return false;
    const drmModeModeInfo mode = ui::kms::rankModes(connector->modes, 0, std::nullopt).front();
    auto output = ui::kms::Output::find(fd_.get(), std::move(*connector));
    auto memory = ui::kms::DumbBuffer::create(fd_.get(), mode.hdisplay, mode.vdisplay);
    if (!output || !memory) return false;
    memory_ = std::move(*memory);
    std::ranges::fill(memory_.bytes(), std::byte{0x77});
    auto framebuffer = ui::kms::Framebuffer::create(fd_.get(), memory_.layout());
    if (!framebuffer) return false;
    framebuffer_ = std::move(*framebuffer);
    return output->light(mode, framebuffer_.id(), -1, 1).has_value();
  }

 private:
  rt::UniqueFd fd_;
  ui::kms::DumbBuffer memory_;
  ui::kms::Framebuffer framebuffer_;
};

class Unplugging : public testing::Test {
 protected:
  void SetUp() override {
    if (!Vkms::available()) GTEST_SKIP() << "this kernel cannot unplug a screen (7.2 can)";
  }
};

TEST_F(Unplugging, TwentyTimesThePictureComesBack) {
  Vkms card("unplugged");
  KmsViewer viewer(KmsViewer::quick(card.card()));
  ASSERT_TRUE(viewer);
  for (int time = 0; time < kTimes; ++time) {
    ASSERT_TRUE(viewer.show()) << "after " << time;
    {
      ScanoutReader reader(::getpid(), card.card());
      ASSERT_EQ(viewer.differs(reader), 0U) << "after " << time;
    }
    card.setConnected(false);
    ASSERT_TRUE(viewer.waitFor(ScreenState::kNoScreen));
    EXPECT_THAT(messageOf(viewer.display()), HasSubstr("no screen at " + card.card()));
    const auto refused = viewer.display().render({});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, rt::Errc::kDeviceLost);
    EXPECT_FALSE(viewer.display().timing());
    card.setConnected(true);
  }
  EXPECT_TRUE(viewer.show());
}

TEST_F(Unplugging, NoScreenAtStartIsWaitedFor) {
  Vkms card("late", false);
  ui::KmsConfig config = KmsViewer::quick(card.card());
  config.renderer.width_px = 320;
  config.renderer.height_px = 240;
  KmsViewer viewer(config);
  ASSERT_TRUE(viewer);
  EXPECT_EQ(viewer.display().screen().state, ScreenState::kNoScreen);
  EXPECT_EQ(viewer.display().mode().width_px, 320U);
  EXPECT_THAT(viewer.display().description(), HasSubstr("no screen"));
  card.setConnected(true);
  ASSERT_TRUE(viewer.show());
  EXPECT_EQ(viewer.display().mode().width_px, 640U);
  ScanoutReader reader(::getpid(), card.card());
  EXPECT_EQ(viewer.differs(reader), 0U);
}

TEST_F(Unplugging, AnotherScreenGetsPicturesOfItsOwnSize) {
  Vkms card("replaced");
  ui::KmsConfig config = KmsViewer::quick(card.card());
  config.mode.clear();
  OtherScreen::offerOnly(640, 480);
  KmsViewer viewer(config);
  ASSERT_TRUE(viewer);
  for (const auto& [width_px, height_px] : {std::pair(640U, 480U), {800U, 600U}, {640U, 480U}}) {
    card.setConnected(false);
    ASSERT_TRUE(viewer.waitFor(ScreenState::kNoScreen));
    OtherScreen::offerOnly(width_px, height_px);
    card.setConnected(true);
    ASSERT_TRUE(viewer.show());
    EXPECT_EQ(viewer.display().mode().width_px, width_px);
    EXPECT_EQ(viewer.display().mode().height_px, height_px);
    ScanoutReader reader(::getpid(), card.card());
    EXPECT_EQ(viewer.differs(reader), 0U);
  }
  OtherScreen::offerOnly(0, 0);
}

TEST_F(Unplugging, AnUnreadableScreenIsSaidAndLeftForABetterOne) {
  Vkms card("unreadable");
  OtherScreen::offerOnly(1, 1);  // a broken EDID: connected, and no mode
  KmsViewer viewer(KmsViewer::quick(card.card()));
  ASSERT_TRUE(viewer);
  EXPECT_EQ(viewer.display().screen().state, ScreenState::kNoScreen);
  EXPECT_THAT(messageOf(viewer.display()), HasSubstr("offers no mode"));
  OtherScreen::offerOnly(0, 0);
  EXPECT_TRUE(viewer.show());
}

TEST(ScreenOfAnother, TwentyTimesThePictureComesBackAfterAnotherProgramShowed) {
  KmsViewer viewer(KmsViewer::quick(kCard));
  ASSERT_TRUE(viewer);
  OtherProgram other(kCard);
  ASSERT_FALSE(other.takeMaster());
  for (int time = 0; time < kTimes; ++time) {
    ASSERT_TRUE(viewer.show()) << "after " << time;
    viewer.display().releaseScreen();
    EXPECT_EQ(viewer.display().screen().state, ScreenState::kReleased);
    EXPECT_THAT(messageOf(viewer.display()), HasSubstr("kagami screen take"));
    EXPECT_EQ(viewer.display().render({}).error().code, rt::Errc::kDeviceLost);
    ASSERT_TRUE(other.takeMaster());
    ASSERT_TRUE(other.showGrey());
    if (time % 4 == 0) {
      // It is asked for before the other one lets go.
      viewer.display().takeScreen();
      ASSERT_TRUE(viewer.waitFor(ScreenState::kNoScreen));
      EXPECT_THAT(messageOf(viewer.display()), HasSubstr("another program"));
      other.dropMaster();
    } else {
      other.dropMaster();
      viewer.display().takeScreen();
    }
    ASSERT_TRUE(viewer.show()) << "after " << time;
    ScanoutReader reader(::getpid(), kCard);
    ASSERT_EQ(viewer.differs(reader), 0U) << "after " << time;
  }
}

TEST(ScreenOfAnother, AtStartIsWaitedFor) {
  OtherProgram other(kCard);
  ASSERT_TRUE(other.master() || other.takeMaster());
  KmsViewer viewer(KmsViewer::quick(kCard));
  ASSERT_TRUE(viewer);
  EXPECT_EQ(viewer.display().screen().state, ScreenState::kNoScreen);
  EXPECT_THAT(messageOf(viewer.display()), HasSubstr("another program"));
  other.dropMaster();
  EXPECT_TRUE(viewer.show());
  EXPECT_EQ(messageOf(viewer.display()), "");
}

TEST(ScreenChanges, ABadLinkIsTrainedAgain) {
  KmsViewer viewer(KmsViewer::quick(kCard));
  ASSERT_TRUE(viewer);
  ASSERT_TRUE(viewer.show());
  const std::uint64_t changes = viewer.display().screen().changes;
  OtherScreen::breakLink();
  const rt::Timestamp end = rt::now() + std::chrono::seconds(20);
  while (viewer.display().screen().changes == changes && rt::now() < end) {
    EXPECT_TRUE(viewer.show());
  }
  EXPECT_GT(viewer.display().screen().changes, changes);
  EXPECT_TRUE(viewer.show());
}

TEST(ScreenChanges, AModeThatTheDriverRefusesGivesWayToTheNext) {
  OtherScreen::refuseModes(2);  // with and without what is only desirable
  KmsViewer viewer(KmsViewer::quick(kCard));
  ASSERT_TRUE(viewer);
  ASSERT_TRUE(viewer.show());
  EXPECT_NE(viewer.display().mode().width_px, 640U);
  EXPECT_THAT(messageOf(viewer.display()), HasSubstr("does not offer"));
}

TEST(ScreenChanges, ADriverThatRefusesEverythingIsTriedAgain) {
  KmsViewer viewer(KmsViewer::quick(kCard));
  ASSERT_TRUE(viewer);
  OtherScreen::refuseModes(100'000);
  EXPECT_FALSE(viewer.show(std::chrono::seconds(2)));
  EXPECT_EQ(viewer.display().screen().state, ScreenState::kNoScreen);
  EXPECT_THAT(messageOf(viewer.display()), HasSubstr("refused"));
  OtherScreen::refuseModes(0);
  EXPECT_TRUE(viewer.show());
}

TEST(BadInput, AModeThatTheScreenDoesNotOfferIsSaid) {
  ui::KmsConfig config = KmsViewer::quick(kCard);
  config.mode = "641x481@50";
  KmsViewer viewer(config);
  ASSERT_TRUE(viewer);
  EXPECT_TRUE(viewer.show());
  EXPECT_THAT(messageOf(viewer.display()), HasSubstr("does not offer display.mode"));
}

std::string complaint(const ui::KmsConfig& config) {
  const auto display = ui::KmsDisplay::create(config);
  if (display) return "none";
  EXPECT_EQ(display.error().find('\n'), std::string::npos);
  return display.error();
}

TEST(BadInput, IsOneClearLine) {
  ui::KmsConfig config = KmsViewer::quick("/dev/dri/card9");
  EXPECT_THAT(complaint(config), HasSubstr("/dev/dri/card9 does not open: No such file"));
  config.device = "/dev/null";
  EXPECT_THAT(complaint(config), HasSubstr("/dev/null drives no screens"));
  config = KmsViewer::quick(kCard);
  config.mode = "large";
  EXPECT_THAT(complaint(config), HasSubstr("display.mode = \"large\""));
  config = KmsViewer::quick(kCard);
  config.queue_depth = 3;
  EXPECT_THAT(complaint(config), HasSubstr("display.queue_depth = 3"));
  OtherScreen::refuseAtomic(true);
  EXPECT_THAT(complaint(KmsViewer::quick(kCard)),
              HasSubstr("its driver vkms has no atomic mode setting"));
  OtherScreen::refuseAtomic(false);
}

TEST(BadInput, NoCardAtAllIsOneClearLine) {
  std::filesystem::rename("/dev/dri", "/dev/dri-away");
  EXPECT_THAT(complaint(KmsViewer::quick("")), HasSubstr("no DRM device"));
  std::filesystem::rename("/dev/dri-away", "/dev/dri");
}

TEST(Device, IsFoundByItsScreen) {
  KmsViewer viewer(KmsViewer::quick(""));
  ASSERT_TRUE(viewer);
  EXPECT_TRUE(viewer.show());
  EXPECT_THAT(viewer.display().description(), HasSubstr("/dev/dri/card"));
}

}  // namespace
}  // namespace test
