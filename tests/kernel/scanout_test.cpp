// What was drawn is what the card sends to the screen, pixel for pixel.

#include <cstdio>
#include <set>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/kernel/support/kms_viewer.h"
#include "ui-kms/kms/connector.h"
#include "ui-kms/kms/mode_choice.h"

namespace test {
namespace {

const std::string kCard = "/dev/dri/card0";

std::vector<drmModeModeInfo> modesOfTheScreen() {
  const rt::UniqueFd fd(::open(kCard.c_str(), O_RDWR | O_CLOEXEC));
  const auto connector = ui::kms::findConnector(fd.get(), ui::kms::Probe::kSearch);
  return connector ? connector->modes : std::vector<drmModeModeInfo>{};
}

TEST(Scanout, ShowsEveryPixelThatWasDrawnInEveryMode) {
  std::set<std::string> shown;
  for (const drmModeModeInfo& mode : modesOfTheScreen()) {
    char spec[32];
    std::snprintf(spec, sizeof spec, "%ux%u@%.2f", mode.hdisplay, mode.vdisplay,
                  ui::kms::refreshHz(mode));
    if (!shown.insert(spec).second) continue;
    ui::KmsConfig config = KmsViewer::quick(kCard);
    config.mode = spec;
    KmsViewer viewer(config);
    ASSERT_TRUE(viewer);
    ASSERT_EQ(viewer.display().mode().width_px, mode.hdisplay);
    ASSERT_EQ(viewer.display().mode().height_px, mode.vdisplay);
    ASSERT_TRUE(viewer.show()) << spec;
    ScanoutReader reader(::getpid(), kCard);
    EXPECT_EQ(viewer.differs(reader), 0U) << spec;
  }
  EXPECT_GT(shown.size(), 5U);
  std::printf("%zu modes shown and read back\n", shown.size());
}

class ScanoutPaths : public testing::TestWithParam<ui::ScanoutPath> {};

TEST_P(ScanoutPaths, ShowsEveryPixelThatWasDrawnPictureAfterPicture) {
  ui::KmsConfig config = KmsViewer::quick(kCard);
  config.path = GetParam();
  config.queue_depth = 2;
  KmsViewer viewer(config);
  ASSERT_TRUE(viewer);
  EXPECT_EQ(viewer.display().path(), GetParam());
  ASSERT_TRUE(viewer.show());
  ScanoutReader reader(::getpid(), kCard);
  ScannedOut before;
  for (int picture = 0; picture < 8; ++picture) {
    ASSERT_TRUE(viewer.show());
    const ScannedOut now = reader.read();
    EXPECT_EQ(differingPixels(viewer.drawn(), now), 0U);
    EXPECT_GT(differingPixels(before, now), 0U) << "the pictures look alike";
    before = now;
  }
}

INSTANTIATE_TEST_SUITE_P(Paths, ScanoutPaths,
                         testing::Values(ui::ScanoutPath::kDirect, ui::ScanoutPath::kCopied),
                         [](const auto& test) {
                           return test.param == ui::ScanoutPath::kDirect ? "drawn_in_place"
                                                                         : "copied";
                         });

}  // namespace
}  // namespace test
