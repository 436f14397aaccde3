#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ui-kms/kms/mode_choice.h"

namespace {

using ui::kms::ModeSpec;
using ui::kms::rankModes;
using ui::kms::refreshHz;

/// CTA-861 and VESA timings: what a true screen says.
drmModeModeInfo mode(std::uint32_t clock_khz, std::pair<int, int> width, std::pair<int, int> height,
                     std::uint32_t flags = 0, bool preferred = false) {
  drmModeModeInfo info{};
  info.clock = clock_khz;
  info.hdisplay = static_cast<std::uint16_t>(width.first);
  info.htotal = static_cast<std::uint16_t>(width.second);
  info.vdisplay = static_cast<std::uint16_t>(height.first);
  info.vtotal = static_cast<std::uint16_t>(height.second);
  info.flags = flags;
  info.type = preferred ? DRM_MODE_TYPE_DRIVER | DRM_MODE_TYPE_PREFERRED : DRM_MODE_TYPE_DRIVER;
  return info;
}

const drmModeModeInfo k1080p60 = mode(148500, {1920, 2200}, {1080, 1125}, 0, true);
const drmModeModeInfo k1080p5994 = mode(148352, {1920, 2200}, {1080, 1125});
const drmModeModeInfo k1080p50 = mode(148500, {1920, 2640}, {1080, 1125});
const drmModeModeInfo k1080p120 = mode(297000, {1920, 2200}, {1080, 1125});
const drmModeModeInfo k1080i60 = mode(74250, {1920, 2200}, {1080, 1125}, DRM_MODE_FLAG_INTERLACE);
const drmModeModeInfo k720p60 = mode(74250, {1280, 1650}, {720, 750});
const drmModeModeInfo k2160p60 = mode(594000, {3840, 4400}, {2160, 2250});
const std::vector kTelevision = {k1080p60, k1080p5994, k1080p50, k1080p120,
                                 k1080i60, k720p60,    k2160p60};

std::string best(const std::vector<drmModeModeInfo>& modes, double trigger_hz,
                 const std::string& spec = "") {
  return ui::kms::describe(
      rankModes(modes, trigger_hz, ui::kms::parseModeSpec(spec).value()).front());
}

TEST(ModeChoice, KnowsTheTrueRefreshRate) {
  EXPECT_DOUBLE_EQ(refreshHz(k1080p60), 60.0);
  EXPECT_NEAR(refreshHz(k1080p5994), 59.94, 0.001);
  EXPECT_DOUBLE_EQ(refreshHz(k1080i60), 60.0) << "two fields are two refreshes";
  EXPECT_DOUBLE_EQ(refreshHz(mode(12587, {320, 400}, {240, 525}, DRM_MODE_FLAG_DBLSCAN)),
                   12587e3 / 400 / 525 / 2);
  EXPECT_EQ(refreshHz(drmModeModeInfo{}), 0.0) << "a broken mode divides by nothing";
}

TEST(ModeChoice, AWholeMultipleOfTheTriggerRateGoesFirst) {
  EXPECT_EQ(best(kTelevision, 40), "1920x1080 at 120.00 Hz");
  EXPECT_EQ(best(kTelevision, 50), "1920x1080 at 50.00 Hz");
  EXPECT_EQ(best(kTelevision, 25), "1920x1080 at 50.00 Hz");
}

TEST(ModeChoice, ThenWhatTheScreenPrefersThenLargerThenFaster) {
  EXPECT_EQ(best(kTelevision, 60), "1920x1080 at 60.00 Hz");
  EXPECT_EQ(best(kTelevision, 0), "1920x1080 at 60.00 Hz");
  EXPECT_EQ(best(kTelevision, 37), "1920x1080 at 60.00 Hz") << "nothing fits: what it prefers";
  EXPECT_EQ(best({k720p60, k1080p50, k1080p120, k2160p60}, 0), "3840x2160 at 60.00 Hz");
  EXPECT_EQ(best({k720p60, k1080p50, k1080p120}, 0), "1920x1080 at 120.00 Hz");
}

TEST(ModeChoice, ARateWithinHalfAPerCentIsAMultiple) {
  EXPECT_TRUE(ui::kms::isMultiple(59.94, 30));
  EXPECT_TRUE(ui::kms::isMultiple(60, 60));
  EXPECT_TRUE(ui::kms::isMultiple(60.29, 60));
  EXPECT_FALSE(ui::kms::isMultiple(60.31, 60));
  EXPECT_FALSE(ui::kms::isMultiple(60, 40));
  EXPECT_FALSE(ui::kms::isMultiple(30, 60)) << "half a flip per trigger is none";
  EXPECT_FALSE(ui::kms::isMultiple(60, 0));
  EXPECT_FALSE(ui::kms::isMultiple(0, 60));
}

TEST(ModeChoice, WholePicturesGoBeforeTwoFields) {
  EXPECT_EQ(best({k1080i60, k720p60}, 60), "1280x720 at 60.00 Hz");
  EXPECT_EQ(best({k1080i60}, 60), "1920x1080 at 60.00 Hz") << "better than nothing";
}

TEST(ModeChoice, ASitesOwnChoiceGoesBeforeAll) {
  EXPECT_EQ(best(kTelevision, 40, "1920x1080@59.94"), "1920x1080 at 59.94 Hz");
  EXPECT_EQ(best(kTelevision, 40, "1920x1080@60"), "1920x1080 at 60.00 Hz");
  EXPECT_EQ(best(kTelevision, 50, "1920x1080"), "1920x1080 at 50.00 Hz");
  EXPECT_EQ(best(kTelevision, 60, "800x600"), "1920x1080 at 60.00 Hz") << "not offered";
  EXPECT_FALSE(fulfils(k1080p60, ModeSpec{1920, 1080, 50}));
  EXPECT_TRUE(fulfils(k1080p60, ModeSpec{1920, 1080, 0}));
}

TEST(ModeChoice, ReadsASitesOwnChoice) {
  using ui::kms::parseModeSpec;
  EXPECT_EQ(parseModeSpec("").value(), std::nullopt);
  EXPECT_EQ(parseModeSpec("1920x1080").value(), (ModeSpec{1920, 1080, 0}));
  EXPECT_EQ(parseModeSpec("1920x1080@59.94").value(), (ModeSpec{1920, 1080, 59.94}));
  for (const char* bad :
       {"1920", "1920x", "x1080", "1920x1080@", "1920x1080@fast", "0x0", "1920x1080@60p",
        "1920x1080 @60", "-1x5", "1920x1080@-60", "1920x1080@nan", "99999999x2"}) {
    const auto spec = parseModeSpec(bad);
    ASSERT_FALSE(spec) << bad;
    EXPECT_THAT(spec.error(), testing::HasSubstr("write it as")) << bad;
  }
}

TEST(ModeChoice, LeavesOutModesThatCannotBe) {
  EXPECT_TRUE(rankModes(std::vector{drmModeModeInfo{}}, 60, std::nullopt).empty());
  EXPECT_TRUE(rankModes({}, 60, std::nullopt).empty());
}

}  // namespace
