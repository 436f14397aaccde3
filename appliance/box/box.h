#pragma once

#include <array>
#include <expected>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "appliance/box/part_list.h"
#include "appliance/box/parts.h"
#include "appliance/box/shared.h"
#include "appliance/control/bus_object.h"
#include "appliance/jobs/job_registry.h"
#include "appliance/site/site.h"
#include "appliance/status/status.h"

namespace appliance {

/// What a box is made of, besides its site.
struct BoxParts {
  hal::Display& display;                ///< outlives the box
  PictureObserver* observer = nullptr;  ///< likewise; none: no observer
  std::span<const PartEntry> parts = productParts();
  rt::Nanoseconds patience = PartList::kPatience;  ///< for one part to stop
  /// Called with a line for each part that did not stop, after everything else has stopped. It ends
  /// the process, because these parts' threads still use what would be destroyed next.
  std::function<void(const std::vector<std::string>& lines)> on_hang;
};

/// The running box: the boards that parts share, the parts in their order, and the trace around
/// them. It is what the control interface commands and asks.
///
/// Threads  All members: the owner (main), which serves the control interface too. The threads of
///          the parts are those of docs/real-time.md.
/// Errors   start(): one line for a person; nothing is left running.
class Box final : public ControlSink, public StatusSource {
 public:
  [[nodiscard]] static std::expected<std::unique_ptr<Box>, std::string> start(
      const Site& site, const BoxParts& parts);

  ~Box() override;
  Box(const Box&) = delete;
  Box& operator=(const Box&) = delete;

  /// Stops the parts in reverse order, then closes the trace.
  /// Errors: the trace could not be written whole, or a part did not stop.
  std::expected<void, std::string> stop();

  [[nodiscard]] std::optional<CommandId> command(const Command& command) override;
  [[nodiscard]] std::optional<CommandAnswer> nextAnswer() override;
  [[nodiscard]] int answersFd() const override { return commands_.answers().fd(); }
  [[nodiscard]] bool setTarget(const std::array<double, 3>& target_m) override;
  void releaseTarget() override;
  [[nodiscard]] std::expected<std::vector<std::string>, Phrase> loadRig(
      const std::string& text, const std::string& name) override;
  void setScreenReleased(bool released) override;
  [[nodiscard]] Status status() const override;
  /// The parts' own objects on the bus; they hold until the box is destroyed.
  [[nodiscard]] std::vector<BusObject> busObjects() const;
  [[nodiscard]] std::string metrics() const override;
  [[nodiscard]] JobRegistry& jobs() { return jobs_; }

 private:
  Box(const Site& site, const BoxParts& parts);
  [[nodiscard]] std::expected<void, std::string> makeShared(const BoxParts& parts);
  [[nodiscard]] std::expected<void, std::string> makeParts(std::span<const PartEntry> parts);
  void countLosses();
  [[nodiscard]] std::expected<void, std::string> run();
  [[nodiscard]] rt::Timestamp shownExposure() const;
  void endWithout(const std::vector<std::string>& hung);

  const Site site_;
  const std::function<void(const std::vector<std::string>&)> on_hang_;
  MetricsRegistry metrics_;
  Remarks remarks_;
  Threads threads_;
  RigShelf rigs_;
  TargetTrack target_;
  DepthBoard depth_;
  OverlayBoard overlay_;
  CaptureBoard board_;
  CommandInbox commands_;
  CommandId last_command_ = 0;
  CommandSender& control_commands_;
  ShownBoard shown_;
  std::unique_ptr<FrameHistory> history_;
  std::unique_ptr<TraceWriter> trace_;  // none: not traced
  std::unique_ptr<const Shared> shared_;
  PartList parts_;
  MetricsGroup trace_metrics_;
  MetricsGroup command_metrics_;
  JobRegistry jobs_;  // ends first: a work uses the parts
  bool stopped_ = false;
};

}  // namespace appliance
