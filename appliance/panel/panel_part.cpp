#include "appliance/panel/panel_part.h"

#include <atomic>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "appliance/box/shared.h"
#include "appliance/panel/panel_loop.h"
#include "appliance/panel/panel_settings.h"
#include "hal/backends.h"

namespace appliance {
namespace {

class PanelPart final : public Part {
 public:
  PanelPart(const Shared& shared, std::unique_ptr<hal::ButtonPanel> panel)
      : shared_(shared),
        panel_(std::move(panel)),
        commands_(shared.commands.open("panel")),
        loop_(
            *panel_,
            [this](const PanelCommand& given) { commands_.give({given.command, given.cause}); },
            [&shown = shared.shown] { return shown.mode.load(std::memory_order_relaxed); }) {}

  [[nodiscard]] std::string_view name() const override { return "panel"; }

  [[nodiscard]] std::expected<void, std::string> start() override {
    return shared_.threads.startInto(thread_, "panel", shared_.config.realtime.panel,
                                     [this](const auto& stop) { loop_.run(stop); });
  }

  void stop() override { thread_ = {}; }

  void report(Status& status) const override {
    if (loop_.lost()) status.degraded.push_back(remarkOf("panel", phrase<Word::kPanelGone>()));
  }

 private:
  const Shared& shared_;
  const std::unique_ptr<hal::ButtonPanel> panel_;
  CommandSender& commands_;
  PanelLoop loop_;
  rt::Thread thread_;
};

}  // namespace

MadePart makePanelPart(const Shared& shared) {
  const PanelSettings& config = shared.config.panel;
  if (config.backend == "none") return nullptr;
  std::vector<std::string> notes;
  auto panel = hal::openButtonPanel(config.backend, config.device, notes);
  for (const std::string& note : notes) shared.remarks.add("panel", phrase<Word::kPanelNote>(note));
  if (!panel) {
    shared.remarks.add("panel", phrase<Word::kPanelMissing>(panel.error()));
    return nullptr;
  }
  return std::make_unique<PanelPart>(shared, std::move(*panel));
}

}  // namespace appliance
