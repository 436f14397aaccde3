// What every display must do, on a true kernel's screen.

#include <memory>
#include <optional>

#include <gtest/gtest.h>

#include "tests/conformance/display_suite.h"
#include "ui-kms/kms_display.h"

namespace test {
namespace {

std::unique_ptr<hal::Display> make(std::optional<ui::ScanoutPath> path, std::uint32_t depth) {
  ui::KmsConfig config;
  config.device = "/dev/dri/card0";
  config.mode = "640x480";
  config.path = path;
  config.queue_depth = depth;
  auto display = ui::KmsDisplay::create(config);
  if (!display) {
    ADD_FAILURE() << display.error();
    return nullptr;
  }
  return std::move(*display);
}

INSTANTIATE_TEST_SUITE_P(
    Kms, DisplayConformance,
    testing::Values(DisplayBackend{"drawn_in_place",
                                   [] { return make(ui::ScanoutPath::kDirect, 1); }},
                    DisplayBackend{"copied", [] { return make(ui::ScanoutPath::kCopied, 1); }},
                    DisplayBackend{"queue_of_two", [] { return make(std::nullopt, 2); }}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace test
