#include <gmock/gmock.h>

#include "tests/support/skipped_tests.h"

int main(int argc, char** argv) {
  testing::InitGoogleMock(&argc, argv);
  const int failed = RUN_ALL_TESTS();
  return failed != 0 ? failed : test::skippedOrPassed();
}
