#pragma once

#include <cstdint>
#include <expected>
#include <istream>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "appliance/trace/records.h"

/// The trace file: one JSON object a line (docs/trace.md).
namespace appliance {

inline constexpr int kTraceFormat = 1;

/// A whole run in memory, records of one kind in the order of the file.
struct Trace {
  RunRecord run;
  std::vector<TriggerRecord> triggers;
  std::vector<FrameRecord> frames;
  std::vector<SetRecord> sets;
  std::vector<PictureRecord> pictures;
  std::vector<FlipRecord> flips;
  std::vector<LoopbackRecord> loopbacks;
  std::vector<GenlockRecord> genlocks;
  std::vector<StallRecord> stalls;
  std::optional<SummaryRecord> summary;  ///< nothing: the daemon did not shut down cleanly
};

/// Any line of a trace.
using TraceLine =
    std::variant<RunRecord, TriggerRecord, FrameRecord, SetRecord, PictureRecord, FlipRecord,
                 LoopbackRecord, GenlockRecord, StallRecord, SummaryRecord>;

/// One line, without its newline. Errors: what is wrong with it.
[[nodiscard]] std::expected<TraceLine, std::string> parseTraceLine(std::string_view line);

/// The line of one record, newline included.
[[nodiscard]] std::string toLine(const RunRecord& run);
[[nodiscard]] std::string toLine(const SummaryRecord& summary);

/// The same for what threads record, appended to @p text without allocating once that is warm.
void appendLine(std::string& text, const TraceRecord& record);

/// Errors   One line "NAME:LINE: what". Only a last line without its newline (the writer died in
///          it) is left out silently: such a trace has no summary, which the report states.
[[nodiscard]] std::expected<Trace, std::string> readTrace(std::istream& in,
                                                          const std::string& name);
[[nodiscard]] std::expected<Trace, std::string> readTraceFile(const std::string& path);

[[nodiscard]] std::string_view nameOf(hal::FrameStatus status);

}  // namespace appliance
