#include "appliance/overlay/overlay_part.h"

#include <memory>
#include <string>
#include <utility>

#include "appliance/box/shared.h"
#include "appliance/overlay/overlay_loop.h"

namespace appliance {
namespace {

class OverlayPart final : public Part {
 public:
  OverlayPart(const Shared& shared, hal::Typesetter& typesetter)
      : shared_(shared), loop_(shared.overlay, typesetter) {}

  [[nodiscard]] std::string_view name() const override { return "overlay"; }

  [[nodiscard]] std::expected<void, std::string> start() override {
    auto thread = shared_.threads.start("ui", {}, [this](const auto& stop) { loop_.run(stop); });
    if (!thread) return std::unexpected(thread.error());
    thread_ = std::move(*thread);
    return {};
  }

  void stop() override {
    if (!thread_.joinable()) return;
    thread_.requestStop();
    shared_.overlay.subject_changed.ring();
    thread_ = {};
  }

  void report(Status& status) const override {
    if (std::string warning = loop_.warning(); !warning.empty())
      status.degraded.push_back({"overlay", std::move(warning)});
  }

 private:
  const Shared& shared_;
  OverlayLoop loop_;
  rt::Thread thread_;
};

}  // namespace

MadePart makeOverlayPart(const Shared& shared) {
  hal::Typesetter* const typesetter = shared.display.typesetter();
  if (typesetter == nullptr) return nullptr;
  return std::make_unique<OverlayPart>(shared, *typesetter);
}

}  // namespace appliance
