#include "hal/emulated/scripted_panel.h"
#include "tests/conformance/button_panel_suite.h"

namespace test {
namespace {

OpenPanel scripted() {
  return {.hardware = nullptr,
          .panel = std::make_unique<hal::emulated::ScriptedPanel>(
              std::vector<hal::emulated::ScriptedChange>{{50ms, hal::Button::kFreeze, true},
                                                         {100ms, hal::Button::kFreeze, false}},
              rt::now())};
}

INSTANTIATE_TEST_SUITE_P(Backends, ButtonPanelConformance,
                         testing::Values(PanelBackend{"Scripted", scripted}),
                         [](const auto& backend) { return backend.param.name; });

}  // namespace
}  // namespace test
