#include <sstream>

#include "appliance/tools/report.h"
#include "appliance/tools/report_text.h"
#include "appliance/trace/trace_file.h"
#include "tests/fuzz/fuzz_target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::istringstream in{std::string(fuzz::text(data, size))};
  const auto trace = appliance::readTrace(in, "trace.jsonl");
  if (!trace) {
    fuzz::requireOneLine(trace.error());
    return 0;
  }
  const appliance::Report report = appliance::computeReport(
      {.trace = *trace, .wire_log = nullptr, .emulator = nullptr, .warm_up_s = 2});
  fuzz::require(report.whole.frames_received <= report.whole.frames_expected,
                "no more frames are received than were expected");
  (void)appliance::toJson(report);
  (void)appliance::toTable(report);
  return 0;
}
