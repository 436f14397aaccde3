#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "appliance/network/network_plan.h"
#include "tests/property/any_value.h"

namespace {

using appliance::kLinkShare;
using appliance::NetworkParameters;
using appliance::planNetwork;
using property_test::anyIn;

constexpr double kRounding = 1e-9;

NetworkParameters anyNetwork() {
  return {.cameras = anyIn(1U, 65U),
          .width_px = anyIn(16U, 5000U),
          .height_px = anyIn(16U, 5000U),
          .rate_hz = anyIn(1U, 40'000U) * 0.01,
          .packet_size_bytes = anyIn(576U, 16'001U),
          .uplinks = anyIn(1U, 9U),
          .uplink_gbps = anyIn(1U, 400U) * 0.25,
          .camera_link_gbps = anyIn(1U, 200U) * 0.05};
}

/// A network that can carry the frames, at any rate.
NetworkParameters anyPossibleNetwork() {
  NetworkParameters parameters = anyNetwork();
  parameters.rate_hz =
      highestRate_hz(parameters) * (anyIn(1, 1001) / 1000.0);  // exactly the highest, at most
  return parameters;
}

RC_GTEST_PROP(NetworkPlanProperty, FillsNoLinkBeyondItsShare, ()) {
  const NetworkParameters parameters = anyPossibleNetwork();
  const auto plan = planNetwork(parameters);
  RC_ASSERT(plan.has_value());
  RC_ASSERT(plan->uplink_use <= kLinkShare + kRounding);
  RC_ASSERT(plan->camera_link_use <= kLinkShare + kRounding);
  // Counted by all cameras together, too.
  const double bits =
      appliance::frameOnWire(std::uint64_t{parameters.width_px} * parameters.height_px,
                             parameters.packet_size_bytes)
          .bits();
  RC_ASSERT(parameters.cameras * bits * parameters.rate_hz <=
            kLinkShare * parameters.uplinks * parameters.uplink_gbps * 1e9 * (1 + kRounding));
}

RC_GTEST_PROP(NetworkPlanProperty, SendsAFrameBeforeTheNextOneIsDue, ()) {
  const NetworkParameters parameters = anyPossibleNetwork();
  const auto plan = planNetwork(parameters);
  RC_ASSERT(plan.has_value());
  const double period_ns = 1e9 / parameters.rate_hz;
  const double packets =
      appliance::frameOnWire(std::uint64_t{parameters.width_px} * parameters.height_px,
                             parameters.packet_size_bytes)
          .packets;
  RC_ASSERT(static_cast<double>(plan->transfer.count()) <= period_ns + packets);  // rounding
  RC_ASSERT(plan->packet_delay.count() >= 0);
  RC_ASSERT(plan->buffer_bytes <= plan->undelayed_bytes);
}

RC_GTEST_PROP(NetworkPlanProperty, RefusesWithAlternativesThatAreAllAccepted, ()) {
  NetworkParameters parameters = anyNetwork();
  parameters.rate_hz = highestRate_hz(parameters) * (1 + anyIn(1, 5000) * 1e-3);
  const auto plan = planNetwork(parameters);
  RC_ASSERT(!plan.has_value());
  RC_ASSERT(!plan.error().reason.empty());
  for (const auto& alternative : plan.error().alternatives) {
    RC_ASSERT(alternative.parameters != parameters);
    const auto possible = planNetwork(alternative.parameters);
    RC_ASSERT(possible.has_value());
  }
  // A lower rate is always possible where one of a tenth of a hertz is.
  if (highestRate_hz(parameters) >= 0.1) RC_ASSERT(!plan.error().alternatives.empty());
}

RC_GTEST_PROP(NetworkPlanProperty, TakesEveryLowerRateAndFillsLinksInStepWithIt, ()) {
  NetworkParameters fast = anyPossibleNetwork();
  NetworkParameters slow = fast;
  slow.rate_hz *= anyIn(1, 1000) * 1e-3;
  const auto plan_fast = planNetwork(fast);
  const auto plan_slow = planNetwork(slow);
  RC_ASSERT(plan_fast && plan_slow);
  RC_ASSERT(plan_slow->uplink_use < plan_fast->uplink_use);
  RC_ASSERT(plan_slow->highest_rate_hz == plan_fast->highest_rate_hz);
  RC_ASSERT(plan_slow->packet_delay >= plan_fast->packet_delay);
}

}  // namespace
