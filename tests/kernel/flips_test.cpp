// In virtual time CPU work costs none, so a flip that is missed is missed by our logic.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <thread>

#include <gtest/gtest.h>

#include "tests/kernel/support/kms_viewer.h"

namespace test {
namespace {

struct Outcome {
  std::uint64_t missed = 0;      ///< vblanks that passed without a new picture
  double commit_to_flip_ms = 0;  ///< mean
};

/// Draws as often as the display takes it, as a render loop does that sleeps until the last flip is
/// known.
Outcome showAll(ui::KmsDisplay& display, int flips) {
  const rt::Nanoseconds period(std::llround(1e9 / display.mode().refresh_hz));
  Outcome outcome;
  std::map<std::uint64_t, rt::Timestamp> commits;
  const int all = flips;
  std::optional<hal::PageFlip> last;
  std::optional<hal::PageFlip> first;  // sets the mode: it has no vblank's stamp
  std::uint64_t picture = 0;
  while (flips > 0) {
    if (display.render({})) {
      if (const auto commit = display.commit(picture + 1)) commits[++picture] = *commit;
    }
    // A little after the vblank, when its event is there.
    const rt::Timestamp next = last ? last->page_flip + period : rt::now();
    std::this_thread::sleep_for(std::max<rt::Nanoseconds>(next - rt::now(), {}) +
                                std::chrono::milliseconds(1));
    while (const auto flip = display.tryPopFlip()) {
      if (!first) first = flip;
      outcome.commit_to_flip_ms +=
          static_cast<double>((flip->page_flip - commits[flip->picture_id]).count()) / 1e6 / all;
      --flips;
      if (last) {
        const auto vblanks = static_cast<std::int64_t>(flip->vblank - last->vblank);
        outcome.missed += static_cast<std::uint64_t>(vblanks - 1);
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
  return outcome;
}

/// Its commit_to_flip.
double expectNoneMissed(ui::ScanoutPath path, std::uint32_t depth, int flips) {
  ui::KmsConfig config = KmsViewer::quick("/dev/dri/card0");
  config.path = path;
  config.queue_depth = depth;
  KmsViewer viewer(config);
  if (!viewer) return 0;
  const auto [missed, commit_to_flip_ms] = showAll(viewer.display(), flips);
  std::printf("queue depth %u: %lu missed of %d flips, commit_to_flip %.1f ms\n", depth, missed,
              flips, commit_to_flip_ms);
  EXPECT_EQ(missed, 0U);
  const auto timing = viewer.display().timing();
  EXPECT_TRUE(timing);
  if (timing) {
    EXPECT_NEAR(timing->period_ns, 1e9 / viewer.display().mode().refresh_hz, 3'000);
  }
  return commit_to_flip_ms;
}

TEST(Flips, ComeOnTheGridAndNoneIsMissedInAMinute) {
  (void)expectNoneMissed(ui::ScanoutPath::kCopied, 1, 3600);
}

TEST(Flips, AreMissedByNeitherPathAtNeitherDepth) {
  // In place every picture costs this kernel hundreds of page faults: fewer of them.
  const double at_once_ms = expectNoneMissed(ui::ScanoutPath::kDirect, 1, 120);
  const double queued_ms = expectNoneMissed(ui::ScanoutPath::kDirect, 2, 120);
  (void)expectNoneMissed(ui::ScanoutPath::kCopied, 2, 600);
  // The price of depth 2, where pictures come faster than flips: one refresh.
  EXPECT_NEAR(queued_ms - at_once_ms, 1000.0 / 59.94, 1.0);
}

}  // namespace
}  // namespace test
