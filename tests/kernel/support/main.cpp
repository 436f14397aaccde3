// main() of every program of the kernel tier.

#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>

#include "tests/support/skipped_tests.h"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (!testing::GTEST_FLAG(list_tests) && std::getenv("KAGAMI_KERNEL_BED") == nullptr) {
    std::fprintf(stderr,
                 "this program works the devices of a test kernel; ctest boots one for it\n");
    return EXIT_FAILURE;
  }
  const int failed = RUN_ALL_TESTS();
  return failed != 0 ? failed : test::skippedOrPassed();
}
