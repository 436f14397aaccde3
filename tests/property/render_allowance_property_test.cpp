#include <algorithm>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "appliance/render/render_allowance.h"

namespace {

using rt::Nanoseconds;

RC_GTEST_PROP(RenderAllowanceProperty, NoTimeSeesMorePicturesThanItsShareAndTheBurst, ()) {
  const double share = *rc::gen::inRange(1, 101) / 100.0;
  const auto burst = Nanoseconds(*rc::gen::inRange(0, 100'000));
  appliance::RenderAllowance allowance(share, burst);

  struct Picture {
    rt::Timestamp begin;
    Nanoseconds took;
  };
  std::vector<Picture> pictures;
  auto now = rt::fromNs(1'000'000'000);
  const auto count = *rc::gen::inRange(1, 60);
  for (int i = 0; i < count; ++i) {
    now += Nanoseconds(*rc::gen::inRange(0, 50'000));
    now = std::max(now, allowance.nextBegin());
    const auto took = Nanoseconds(*rc::gen::inRange(0, 200'000));
    pictures.push_back({now, took});
    allowance.spend(now, now + took);
    now += took;
  }
  for (std::size_t first = 0; first < pictures.size(); ++first) {
    Nanoseconds taken{0};
    for (std::size_t last = first; last < pictures.size(); ++last) {
      const auto between = pictures[last].begin - pictures[first].begin;
      const double most_ns = share * static_cast<double>((between + burst).count());
      // One nanosecond per picture is lost in rounding.
      RC_ASSERT(static_cast<double>(taken.count()) <=
                most_ns + static_cast<double>(last - first) + 1);
      taken += pictures[last].took;
    }
  }
}

}  // namespace
