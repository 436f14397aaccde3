#include "appliance/trace/trace_file.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <concepts>
#include <cstring>
#include <fstream>
#include <type_traits>
#include <utility>

#include <nlohmann/json.hpp>

#include "appliance/trace/record_fields.h"
#include "rt/printable.h"

namespace appliance {
namespace {

using nlohmann::json;

/// 73 years: what is later is no instant of a run, and sums of instants stay far from overflow.
constexpr std::int64_t kLatest_ns = std::int64_t{1} << 61;

constexpr std::array<std::string_view, 4> kStatusNames = {"complete", "incomplete", "wrong_size",
                                                          "aborted"};

template <class Record>
constexpr const char* kKind = nullptr;
template <>
constexpr const char* kKind<TriggerRecord> = "trigger";
template <>
constexpr const char* kKind<FrameRecord> = "frame";
template <>
constexpr const char* kKind<SetRecord> = "set";
template <>
constexpr const char* kKind<PictureRecord> = "picture";
template <>
constexpr const char* kKind<FlipRecord> = "flip";
template <>
constexpr const char* kKind<LoopbackRecord> = "loopback";
template <>
constexpr const char* kKind<GenlockRecord> = "genlock";
template <>
constexpr const char* kKind<StallRecord> = "stall";

/// Appends the fields of the frequent records; they hold no text of the world, so nothing is
/// escaped.
class LineAppender {
 public:
  explicit LineAppender(std::string& text) : text_(text) {}

  void operator()(const char* name, rt::Timestamp instant) { number(name, rt::toNs(instant)); }
  void operator()(const char* name, bool value) { key(name).append(value ? "true" : "false"); }
  void operator()(const char* name, Mode mode) { word(name, nameOf(mode)); }
  void operator()(const char* name, hal::FrameStatus status) { word(name, nameOf(status)); }
  void operator()(const char* name, GenlockState state) { word(name, nameOf(state)); }
  void operator()(const char* name, GenlockReason reason) { word(name, nameOf(reason)); }
  void operator()(const char* name, rt::Nanoseconds time) { number(name, time.count()); }
  void operator()(const char* name, std::unsigned_integral auto value) { number(name, value); }

 private:
  std::string& key(const char* name) { return text_.append(",\"").append(name).append("\":"); }
  void word(const char* name, std::string_view value) {
    key(name).append("\"").append(value).append("\"");
  }
  void number(const char* name, std::integral auto value) {
    std::array<char, 24> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    key(name).append(digits.data(), end);
  }

  std::string& text_;
};

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};

json toJson(const TracedThread& grant);

/// Fills a JSON object with the fields of the two records that carry text.
struct JsonFiller {
  json& object;
  template <class T>
  void operator()(const char* name, const T& value) {
    object[name] = value;
  }
  void operator()(const char* name, rt::Timestamp instant) { object[name] = rt::toNs(instant); }
  void operator()(const char* name, const std::vector<TracedThread>& grants) {
    json& list = object[name] = json::array();
    for (const TracedThread& grant : grants) list.push_back(toJson(grant));
  }
};

json toJson(const TracedThread& grant) {
  json object;
  visitFields(grant, JsonFiller{object});
  return object;
}

/// Takes the fields of one record out of a parsed line; the first thing that is wrong stays.
struct JsonReader {
  const json& object;
  std::string& error;

  /// Fields that older traces of the same format do not have.
  static bool isNew(std::string_view name) {
    return name == "version" || name == "second_camera" || name == "second_trigger";
  }

  template <class T>
  void operator()(const char* name, T& value) {
    if (!error.empty()) return;
    const auto found = object.find(name);
    if (found == object.end() && !isNew(name))
      error = std::string("no field '") + name + "'";
    else if (found != object.end() && !take(*found, value))
      error = std::string("field '") + name + "' has the wrong type or value";
  }

 private:
  static bool take(const json& from, bool& to) {
    if (!from.is_boolean()) return false;
    to = from.get<bool>();
    return true;
  }
  static bool take(const json& from, std::string& to) {
    if (!from.is_string()) return false;
    to = from.get<std::string>();
    return true;
  }
  static bool take(const json& from, double& to) {
    if (!from.is_number()) return false;
    to = from.get<double>();
    return true;
  }
  template <std::integral T>
  static bool take(const json& from, T& to) {
    if (!from.is_number_integer()) return false;
    if (from.is_number_unsigned()) {
      const auto value = from.get<std::uint64_t>();
      to = static_cast<T>(value);
      return std::in_range<T>(value);
    }
    const auto value = from.get<std::int64_t>();
    to = static_cast<T>(value);
    return std::in_range<T>(value);
  }
  static bool take(const json& from, rt::Timestamp& to) {
    std::int64_t t_ns = 0;
    if (!take(from, t_ns) || t_ns < 0 || t_ns > kLatest_ns) return false;
    to = rt::fromNs(t_ns);
    return true;
  }
  static bool take(const json& from, rt::Nanoseconds& to) {
    std::int64_t time_ns = 0;
    if (!take(from, time_ns) || time_ns < -kLatest_ns || time_ns > kLatest_ns) return false;
    to = rt::Nanoseconds(time_ns);
    return true;
  }
  static bool take(const json& from, GenlockState& to) {
    return takeName(from, kGenlockStateNames, to);
  }
  static bool take(const json& from, GenlockReason& to) {
    return takeName(from, kGenlockReasonNames, to);
  }
  static bool take(const json& from, Mode& to) {
    if (!from.is_string()) return false;
    const auto mode = modeNamed(from.get_ref<const std::string&>());
    to = mode.value_or(to);
    return mode.has_value();
  }
  static bool take(const json& from, hal::FrameStatus& to) {
    return takeName(from, kStatusNames, to);
  }
  static bool take(const json& from, std::vector<std::string>& to) {
    if (!from.is_array()) return false;
    for (const json& item : from)
      if (!take(item, to.emplace_back())) return false;
    return true;
  }
  static bool take(const json& from, std::vector<TracedThread>& to) {
    if (!from.is_array()) return false;
    for (const json& item : from) {
      std::string wrong;
      if (!item.is_object()) return false;
      visitFields(to.emplace_back(), JsonReader{item, wrong});
      if (!wrong.empty()) return false;
    }
    return true;
  }
  template <class Enum, std::size_t N>
  static bool takeName(const json& from, const std::array<std::string_view, N>& names, Enum& to) {
    if (!from.is_string()) return false;
    const auto& text = from.get_ref<const std::string&>();
    for (std::size_t i = 0; i < N; ++i) {
      if (text != names[i]) continue;
      to = static_cast<Enum>(i);
      return true;
    }
    return false;
  }
};

template <class Record>
std::expected<TraceLine, std::string> readAs(const json& object) {
  Record record;
  std::string error;
  visitFields(record, JsonReader{object, error});
  if (!error.empty()) return std::unexpected(error);
  return record;
}

/// Puts one record where it belongs; what is wrong with its place, or nothing.
std::string take(TraceLine line, bool first, Trace& trace) {
  if (first != std::holds_alternative<RunRecord>(line))
    return first ? "the first line of a trace is its run record" : "a second run record";
  if (trace.summary) return "a record after the summary";
  if (const auto* frame = std::get_if<FrameRecord>(&line);
      frame != nullptr && frame->camera >= trace.run.cameras)
    return "a frame of camera " + std::to_string(frame->camera) + ", counted from 0: the run has " +
           std::to_string(trace.run.cameras);
  std::visit(Overloaded{[&](RunRecord& run) { trace.run = std::move(run); },
                        [&](TriggerRecord& trigger) { trace.triggers.push_back(trigger); },
                        [&](FrameRecord& frame) { trace.frames.push_back(frame); },
                        [&](SetRecord& set) { trace.sets.push_back(set); },
                        [&](PictureRecord& picture) { trace.pictures.push_back(picture); },
                        [&](FlipRecord& flip) { trace.flips.push_back(flip); },
                        [&](LoopbackRecord& edge) { trace.loopbacks.push_back(edge); },
                        [&](GenlockRecord& genlock) { trace.genlocks.push_back(genlock); },
                        [&](StallRecord& stall) { trace.stalls.push_back(stall); },
                        [&](SummaryRecord& summary) { trace.summary = summary; }},
             line);
  return {};
}

}  // namespace

std::string_view nameOf(hal::FrameStatus status) {
  return kStatusNames[static_cast<std::size_t>(status)];
}

std::string toLine(const RunRecord& run) {
  json object = {{"record", "run"}, {"format", kTraceFormat}};
  visitFields(run, JsonFiller{object});
  return object.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

std::string toLine(const SummaryRecord& summary) {
  json object = {{"record", "summary"}};
  visitFields(summary, JsonFiller{object});
  return object.dump() + "\n";
}

void appendLine(std::string& text, const TraceRecord& record) {
  std::visit(
      [&](const auto& one) {
        text.append("{\"record\":\"").append(kKind<std::decay_t<decltype(one)>>).append("\"");
        visitFields(one, LineAppender(text));
        text.append("}\n");
      },
      record);
}

std::expected<TraceLine, std::string> parseTraceLine(std::string_view line) {
  const json object = json::parse(line, nullptr, false);
  if (!object.is_object()) return std::unexpected("this is not a JSON object");
  const auto record = object.find("record");
  const std::string kind =
      record != object.end() && record->is_string() ? record->get<std::string>() : "";
  if (kind == "run") {
    const auto format = object.find("format");
    if (format == object.end() || *format != kTraceFormat)
      return std::unexpected("not a trace of format " + std::to_string(kTraceFormat));
    return readAs<RunRecord>(object);
  }
  if (kind == kKind<TriggerRecord>) return readAs<TriggerRecord>(object);
  if (kind == kKind<FrameRecord>) return readAs<FrameRecord>(object);
  if (kind == kKind<SetRecord>) return readAs<SetRecord>(object);
  if (kind == kKind<PictureRecord>) return readAs<PictureRecord>(object);
  if (kind == kKind<FlipRecord>) return readAs<FlipRecord>(object);
  if (kind == kKind<LoopbackRecord>) return readAs<LoopbackRecord>(object);
  if (kind == kKind<GenlockRecord>) return readAs<GenlockRecord>(object);
  if (kind == kKind<StallRecord>) return readAs<StallRecord>(object);
  if (kind == "summary") return readAs<SummaryRecord>(object);
  return std::unexpected("unknown record '" + rt::printable(kind) + "'");
}

std::expected<Trace, std::string> readTrace(std::istream& in, const std::string& name) {
  Trace trace;
  std::string line;
  std::size_t count = 0;
  while (std::getline(in, line)) {
    const bool cut_off = in.eof();
    ++count;
    if (cut_off && count > 1) break;
    auto record = parseTraceLine(line);
    const std::string wrong =
        record ? take(std::move(*record), count == 1, trace) : std::move(record.error());
    if (!wrong.empty()) return std::unexpected(name + ":" + std::to_string(count) + ": " + wrong);
  }
  if (count == 0) return std::unexpected(name + ": this trace is empty");
  return trace;
}

std::expected<Trace, std::string> readTraceFile(const std::string& path) {
  std::ifstream in(path);
  if (!in) return std::unexpected(path + ": cannot read the trace: " + std::strerror(errno));
  return readTrace(in, path);
}

}  // namespace appliance
