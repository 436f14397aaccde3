// In virtual time CPU work costs none, so a flip that is missed is missed by our logic.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <thread>

#include <gtest/gtest.h>

#include "tests/kernel/support/kms_viewer.h"

namespace test {
namespace {

/// Shows a picture per vblank, as a render loop does that sleeps until the last flip is told.
/// How many vblanks passed without a new picture.
std::uint64_t missedOf(ui::KmsDisplay& display, int flips) {
  const rt::Nanoseconds period(std::llround(1e9 / display.mode().refresh_hz));
  std::uint64_t missed = 0;
  std::optional<hal::PageFlip> last;
  std::optional<hal::PageFlip> first;  // sets the mode: it has no vblank's stamp
  std::uint64_t picture = 0;
  while (flips > 0) {
    if (display.render(nullptr, {})) {
      if (display.commit(picture + 1)) ++picture;
    }
    // A little after the vblank, when its event is there.
    const rt::Timestamp next = last ? last->page_flip + period : rt::now();
    std::this_thread::sleep_for(std::max<rt::Nanoseconds>(next - rt::now(), {}) +
                                std::chrono::milliseconds(1));
    while (const auto flip = display.tryPopFlip()) {
      if (!first) first = flip;
      --flips;
      if (last) {
        const auto vblanks = static_cast<std::int64_t>(flip->vblank - last->vblank);
        missed += static_cast<std::uint64_t>(vblanks - 1);
        EXPECT_EQ(flip->picture_id, last->picture_id + 1);
        if (last->picture_id == first->picture_id) {
          last = flip;
          continue;
        }
        // Stamps are whole microseconds; so is VKMS's period, nearly.
        EXPECT_NEAR(static_cast<double>((flip->page_flip - last->page_flip).count()),
                    static_cast<double>((vblanks * period).count()), 3'000)
            << "vblank " << flip->vblank;
      }
      last = flip;
    }
  }
  return missed;
}

void expectNoneMissed(ui::ScanoutPath path, std::uint32_t depth, int flips) {
  ui::KmsConfig config = KmsViewer::quick("/dev/dri/card0");
  config.path = path;
  config.queue_depth = depth;
  KmsViewer viewer(config);
  ASSERT_TRUE(viewer);
  const std::uint64_t missed = missedOf(viewer.display(), flips);
  std::printf("queue depth %u: %lu missed of %d flips\n", depth, missed, flips);
  EXPECT_EQ(missed, 0U);
  const auto timing = viewer.display().timing();
  ASSERT_TRUE(timing);
  EXPECT_NEAR(timing->period_ns, 1e9 / viewer.display().mode().refresh_hz, 3'000);
}

TEST(Flips, ComeOnTheGridAndNoneIsMissedInAMinute) {
  expectNoneMissed(ui::ScanoutPath::kCopied, 1, 3600);
}

TEST(Flips, AreMissedByNeitherPathAtNeitherDepth) {
  // In place every picture costs this kernel hundreds of page faults: fewer of them.
  expectNoneMissed(ui::ScanoutPath::kDirect, 1, 120);
  expectNoneMissed(ui::ScanoutPath::kDirect, 2, 120);
  expectNoneMissed(ui::ScanoutPath::kCopied, 2, 600);
}

}  // namespace
}  // namespace test
