#include "appliance/control/status_properties.h"

#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using appliance::changedProperties;
using appliance::Status;
using appliance::statusProperties;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::StrEq;
using testing::UnorderedElementsAre;

Status running() {
  Status status;
  status.cameras.resize(2);
  status.cameras[0].name = "left";
  status.cameras[1].name = "right";
  return status;
}

TEST(StatusProperties, EveryValueHasTheTypeThatTheTableNames) {
  for (const auto& property : statusProperties())
    EXPECT_STREQ(property.type, appliance::typeOf(property.value(running()))) << property.name;
}

TEST(StatusProperties, ASnapshotThatSaysTheSameSignalsNothing) {
  EXPECT_THAT(changedProperties(running(), running()), IsEmpty());
}

TEST(StatusProperties, SignalsOnlyWhatChanged) {
  Status now = running();
  now.mode = appliance::Mode::kFrozen;
  now.view_wanted = 1;
  EXPECT_THAT(changedProperties(running(), now),
              UnorderedElementsAre(StrEq("Mode"), StrEq("View")));
}

TEST(StatusProperties, WhatMovesAtEveryLookIsNotSignalled) {
  Status now = running();
  now.triggers = 400;
  now.delay_ms = 25;
  now.history_ms = 7500;
  now.shown_hz = 39.9;
  now.frames_away = 7;
  EXPECT_THAT(changedProperties(running(), now), IsEmpty());
}

TEST(StatusProperties, AReasonThatCountsSecondsIsSignalledOnce) {
  Status before = running();
  before.cameras[1].state = appliance::CameraState::kLost;
  before.cameras[1].reason = "no frames since 0.4 s: check its cable";
  EXPECT_THAT(changedProperties(running(), before), ElementsAre(StrEq("Cameras")));
  Status now = before;
  now.cameras[1].reason = "no frames since 0.5 s: check its cable";
  EXPECT_THAT(changedProperties(before, now), IsEmpty());

  before.degraded = {{"depth sensor", "depth sensor: silent for 1.1 s"}};
  now = before;
  now.degraded = {{"depth sensor", "depth sensor: silent for 1.2 s"}};
  EXPECT_THAT(changedProperties(before, now), IsEmpty());
  now.degraded = {{"depth sensor", "depth sensor: its driver crashed"}};
  EXPECT_THAT(changedProperties(before, now), ElementsAre(StrEq("Degraded")));
}

}  // namespace
