#include "hal/openni/oni_header.h"

#include <chrono>
#include <fstream>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace {

using hal::openni::writeStreamCount;
using testing::HasSubstr;
using namespace std::chrono_literals;

/// What OpenNI2 writes first where it was quicker than its caller: one stream, and pictures after.
const std::string kBegun("NI10\1\0\1\0\0\0\0\0\xff\xff\xff\xff\xff\xff\xff\xff\1\0\0\0NIR", 27);

std::string contentsOf(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

TEST(OniHeader, GetsTheNumberOfStreamsAndNothingElse) {
  const test::TemporaryFolder scratch;
  std::ofstream(scratch / "a.oni", std::ios::binary) << kBegun;
  ASSERT_TRUE(writeStreamCount(scratch / "a.oni", 2, 0ns));
  std::string wanted = kBegun;
  wanted[20] = 2;
  EXPECT_EQ(contentsOf(scratch / "a.oni"), wanted);
}

TEST(OniHeader, IsLeftAloneUntilItIsThere) {
  const test::TemporaryFolder scratch;
  std::ofstream(scratch / "a.oni", std::ios::binary) << kBegun.substr(0, 23);
  const auto written = writeStreamCount(scratch / "a.oni", 2, 3ms);
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error(), HasSubstr("a.oni: OpenNI2 does not write it"));
  EXPECT_EQ(contentsOf(scratch / "a.oni"), kBegun.substr(0, 23));
}

TEST(OniHeader, OfAFileThatCannotBeWrittenIsAnError) {
  const auto written = writeStreamCount("/nowhere/a.oni", 2, 0ns);
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error(), HasSubstr("/nowhere/a.oni: cannot be written"));
}

}  // namespace
