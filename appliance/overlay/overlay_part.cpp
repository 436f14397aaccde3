#include "appliance/overlay/overlay_part.h"

#include <memory>
#include <string>
#include <utility>

#include "appliance/box/shared.h"
#include "appliance/overlay/overlay_loop.h"
#include "rt/ringed_thread.h"

namespace appliance {
namespace {

class OverlayPart final : public Part {
 public:
  OverlayPart(const Shared& shared, hal::Typesetter& typesetter)
      : shared_(shared),
        loop_(shared.overlay, typesetter),
        thread_(shared.overlay.subject_changed) {}

  [[nodiscard]] std::string_view name() const override { return "overlay"; }

  [[nodiscard]] std::expected<void, std::string> start() override {
    return shared_.threads.startInto(thread_.thread(), "ui", {},
                                     [this](const auto& stop) { loop_.run(stop); });
  }

  void stop() override { thread_.stop(); }

  void report(Status& status) const override {
    if (const std::string warning = loop_.warning(); !warning.empty())
      status.degraded.push_back(remarkOf("overlay", phrase<Word::kOverlayNote>(warning)));
  }

 private:
  const Shared& shared_;
  OverlayLoop loop_;
  rt::RingedThread thread_;
};

}  // namespace

MadePart makeOverlayPart(const Shared& shared) {
  hal::Typesetter* const typesetter = shared.display.typesetter();
  if (typesetter == nullptr) return nullptr;
  return std::make_unique<OverlayPart>(shared, *typesetter);
}

}  // namespace appliance
