#include <filesystem>

#include <gtest/gtest.h>

#include "hal/openni/driver_stage.h"
#include "tests/support/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using hal::openni::DriverStage;

TEST(DriverStage, RemovesItsOwnFolderOnly) {
  const test::TemporaryFolder scratch;
  const fs::path own = scratch / "kagami-openni-abcdef";
  const fs::path other = scratch / "holiday-pictures";
  fs::create_directories(own);
  fs::create_directories(other);
  {
    const DriverStage stage(own);
  }
  {
    const DriverStage stage(other);
  }
  EXPECT_FALSE(fs::exists(own));
  EXPECT_TRUE(fs::exists(other)) << "whatever the environment says";
}

}  // namespace
