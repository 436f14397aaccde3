#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

namespace test {

inline constexpr int kSkipped = 77;  // as SKIP_RETURN_CODE says to ctest

inline void printSkipped(const std::string& what, const testing::TestResult& result) {
  std::string reason = result.GetTestPartResult(0).message();
  for (char& c : reason) c = c == '\n' ? ' ' : c;
  std::printf("SKIPPED: %s: %s\n", what.c_str(), reason.c_str());
}

/// For the end of main(), after tests that all passed or were skipped: a line for each skipped one
/// with its reason, and an exit status that says whether there was any.
inline int skippedOrPassed() {
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  int skipped = 0;
  for (int s = 0; s < all.total_test_suite_count(); ++s) {
    const testing::TestSuite& suite = *all.GetTestSuite(s);
    if (suite.ad_hoc_test_result().Skipped()) {
      skipped += suite.test_to_run_count();
      printSkipped(suite.name(), suite.ad_hoc_test_result());
      continue;
    }
    for (int t = 0; t < suite.total_test_count(); ++t) {
      const testing::TestResult& result = *suite.GetTestInfo(t)->result();
      if (!result.Skipped()) continue;
      ++skipped;
      printSkipped(std::string(suite.name()) + "." + suite.GetTestInfo(t)->name(), result);
    }
  }
  return skipped > 0 ? kSkipped : EXIT_SUCCESS;
}

}  // namespace test
