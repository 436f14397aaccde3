#pragma once

#include <functional>
#include <memory>
#include <optional>

#include <gtest/gtest.h>

#include "hal/trigger_line.h"

/// What every backend of hal::TriggerLine must do. A test program includes this once and
/// instantiates TriggerLineConformance with its backends.
namespace test {

/// The far end of a trigger line: what the camera's input sees.
class LineObserver {
 public:
  virtual ~LineObserver() = default;
  /// The line's new level, when it changes within a generous time.
  virtual std::optional<bool> waitLevel() = 0;
  /// The instant that the backend's last edge carries, where it carries one.
  [[nodiscard]] virtual std::optional<rt::Timestamp> edgeStamp() const { return std::nullopt; }
};

struct ObservedLine {
  std::unique_ptr<LineObserver> observer;
  std::unique_ptr<hal::TriggerLine> line;
};

struct LineBackend {
  const char* name;
  std::function<ObservedLine()> open;
};

class TriggerLineConformance : public testing::TestWithParam<LineBackend> {
 protected:
  void SetUp() override { ASSERT_TRUE(rig_.line && rig_.observer) << "the backend did not open"; }
  ObservedLine rig_ = GetParam().open();
};

TEST_P(TriggerLineConformance, BracketsEveryEdge) {
  for (const bool active : {true, false, true, false}) {
    const rt::Timestamp before = rt::now();
    const auto edge = rig_.line->setActive(active);
    const rt::Timestamp after = rt::now();
    ASSERT_TRUE(edge);
    EXPECT_LE(before, edge->before);
    EXPECT_LE(edge->before, edge->after);
    EXPECT_LE(edge->after, after);
    EXPECT_EQ(rig_.observer->waitLevel(), active);
    if (const auto stamp = rig_.observer->edgeStamp()) {
      EXPECT_GE(*stamp, edge->before);
      EXPECT_LE(*stamp, edge->after);
    }
  }
}

TEST_P(TriggerLineConformance, IsInactiveWhenItGoes) {
  ASSERT_TRUE(rig_.line->setActive(true));
  EXPECT_EQ(rig_.observer->waitLevel(), true);
  rig_.line.reset();
  EXPECT_EQ(rig_.observer->waitLevel(), false);
}

TEST_P(TriggerLineConformance, LosesNoEdgeOfAFastTrain) {
  constexpr int kEdges = 200;
  for (int i = 0; i < kEdges; ++i) ASSERT_TRUE(rig_.line->setActive(i % 2 == 0));
  for (int i = 0; i < kEdges; ++i) ASSERT_EQ(rig_.observer->waitLevel(), i % 2 == 0) << i;
}

}  // namespace test
