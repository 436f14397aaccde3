// main() of every program of the kernel tier.

#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>

namespace {

constexpr int kSkipped = 77;  // as SKIP_RETURN_CODE says to ctest

/// What was skipped must not count as passed: one line for each, and a status that says so.
int skippedOrPassed() {
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  int skipped = 0;
  for (int s = 0; s < all.total_test_suite_count(); ++s) {
    const testing::TestSuite& suite = *all.GetTestSuite(s);
    for (int t = 0; t < suite.total_test_count(); ++t) {
      const testing::TestResult& result = *suite.GetTestInfo(t)->result();
      if (!result.Skipped()) continue;
      ++skipped;
      std::printf("SKIPPED: %s.%s: %s\n", suite.name(), suite.GetTestInfo(t)->name(),
                  result.GetTestPartResult(0).message());
    }
  }
  return skipped > 0 ? kSkipped : EXIT_SUCCESS;
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (!testing::GTEST_FLAG(list_tests) && std::getenv("KAGAMI_KERNEL_BED") == nullptr) {
    std::fprintf(stderr,
                 "this program works the devices of a test kernel; ctest boots one for it\n");
    return EXIT_FAILURE;
  }
  const int failed = RUN_ALL_TESTS();
  return failed != 0 ? failed : skippedOrPassed();
}
