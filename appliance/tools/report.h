#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "appliance/tools/distribution.h"
#include "appliance/tools/emulator_files.h"
#include "appliance/tools/genlock_report.h"
#include "appliance/trace/trace_file.h"

namespace appliance {

/// Frames of a stretch of the run, from first to last trigger.
struct FrameCounts {
  double seconds = 0;  ///< from the first edge to the last, and one period
  std::uint64_t triggers = 0;
  std::uint64_t frames_expected = 0;              ///< triggers x cameras
  std::uint64_t frames_received = 0;              ///< complete and attributed to a trigger
  std::uint64_t frames_incomplete = 0;            ///< arrived, but not whole or not as configured
  std::uint64_t frames_lost = 0;                  ///< expected, but neither of these came
  std::uint64_t frames_unattributed = 0;          ///< complete, but near no trigger edge: lost, too
  std::uint64_t frames_lost_in_stalls = 0;        ///< of frames_lost, while the machine stood still
  std::uint64_t frames_incomplete_in_stalls = 0;  ///< of frames_incomplete, likewise

  /// What the machine does not explain.
  [[nodiscard]] std::uint64_t lostByUs() const { return frames_lost - frames_lost_in_stalls; }
  [[nodiscard]] std::uint64_t incompleteByUs() const {
    return frames_incomplete - frames_incomplete_in_stalls;
  }
};

/// How often and for how long the machine itself stood still.
struct StallFigures {
  std::uint64_t count = 0;
  double longest_ms = 0;
  double total_ms = 0;
};

/// Where the milliseconds go. docs/trace.md says what each is measured between.
struct StageTimes {
  Distribution trigger_edge_to_frame_ready;
  Distribution last_packet_to_commit;
  Distribution target_point;
  Distribution homographies;
  Distribution demosaic_upload;
  Distribution warp;
  Distribution commit_to_flip;
  Distribution trigger_edge_to_page_flip;
};

struct ModeTimes {
  std::uint64_t pictures = 0;
  Distribution wake_to_commit_ms;
  Distribution trigger_edge_to_commit_ms;  ///< of pictures that show a new frame
};

/// A bar that the figures are held against. Not measured: no value.
struct Bar {
  std::string what;
  std::optional<double> value;
  bool at_least = false;  ///< else: at most
  double limit = 0;
  [[nodiscard]] std::optional<bool> passed() const {
    if (!value) return std::nullopt;
    return at_least ? *value >= limit : *value <= limit;
  }
};

/// The figures of one run, every one computed from recorded instants.
struct Report {
  RunRecord run;
  FrameCounts whole;
  FrameCounts after_warm_up;
  StallFigures stalls;
  double warm_up_s = 0;
  bool valid = false;
  std::vector<std::string> invalid_reasons;

  std::uint64_t pictures = 0;
  std::uint64_t pictures_imported = 0;  ///< their frames were read in their slots, not uploaded
  std::uint64_t pictures_repeated = 0;  ///< live or delayed, same frame as the one before
  double shown_fps = 0;  ///< distinct frame sets a second in the live and delayed phases
  Distribution trigger_lateness_us;
  Distribution trigger_edge_delay_us;  ///< to the loop-back; without one there is none
  Distribution button_to_commit_ms;
  StageTimes stages_ms;
  std::array<ModeTimes, kModes.size()> by_mode;  ///< in the order of Mode
  GenlockReport genlock;

  bool last_packet_from_wire_log = false;  ///< else as the receiving thread saw it
  /// Frames whose trigger is not the one that the emulator answered; nothing without a wire log.
  std::optional<std::uint64_t> frames_misattributed;

  double cpu_seconds_kagamid = 0;
  std::optional<double> cpu_seconds_emulator;
  std::uint64_t memory_bytes = 0;
  std::vector<Bar> bars;
};

struct ReportInput {
  const Trace& trace;
  const std::vector<SentFrame>* wire_log = nullptr;
  const EmulatorStatistics* emulator = nullptr;
  double warm_up_s = 2;  ///< left out where frames lost are judged, nowhere else
};

/// Pure. A trace without triggers or pictures gives a report without figures, not valid.
[[nodiscard]] Report computeReport(const ReportInput& input);

}  // namespace appliance
