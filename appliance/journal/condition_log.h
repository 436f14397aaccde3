#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "appliance/journal/log.h"
#include "rt/clock.h"

namespace appliance {

/// Something that lasts for a while and is worth a line when it begins and when it ends.
struct Condition {
  enum class Now : std::uint8_t {
    kHolds,
    kOver,
    kUnclear,  ///< neither begins nor ends: a camera on its way back
  };

  std::string key;   ///< the same as long as it lasts: "camera 7"
  std::string kind;  ///< while it lasts, another kind is a line of its own
  Now now = Now::kHolds;
  LogLevel level = LogLevel::kWarning;
  std::string text;  ///< the line at its begin; may change while it lasts, without a line
  LogLevel end_level = LogLevel::kNotice;
  std::string end;                 ///< the line at its end
  Word word = Word::kNothing;      ///< what text says
  Word end_word = Word::kNothing;  ///< what end says
  std::uint64_t begins = 0;        ///< how often it began so far, if the source counts that; else 0
};

/// Turns what holds now into journal lines: one at a condition's begin, one at its end. A condition
/// that comes and goes all the time has a line each kRefill, with the count of what happened since
/// its last line. No condition is silenced for good.
///
/// Threads  main.
/// Memory   Forgets a condition that has been over for kForgetAfter; beyond kMostRemembered, each
///          one that is over.
class ConditionLog {
 public:
  /// Lines of one condition without a pause; then one each kRefill.
  static constexpr double kBurst = 6;
  static constexpr rt::Nanoseconds kRefill = std::chrono::seconds(10);
  /// The same for all conditions together, in case very many change all the time.
  static constexpr double kBurstOfAll = 100;
  static constexpr rt::Nanoseconds kRefillOfAll = std::chrono::seconds(1);
  static constexpr rt::Nanoseconds kForgetAfter = std::chrono::minutes(2);
  static constexpr std::size_t kMostRemembered = 1000;

  /// @p now rises from look to look. What is not among @p conditions is over.
  [[nodiscard]] std::vector<JournalLine> look(rt::Timestamp now,
                                              std::span<const Condition> conditions);

  [[nodiscard]] std::size_t remembered() const { return entries_.size(); }

 private:
  /// A number of lines that refills with time.
  struct Allowance {
    double lines;
    rt::Timestamp counted_at;
    [[nodiscard]] bool take(rt::Timestamp now, double burst, rt::Nanoseconds refill);
  };
  struct Entry {
    Condition last;  // as it was when it last held
    bool holds = false;
    bool said = false;         // the journal's last line says that it holds
    std::string said_kind;     // and of which kind
    std::uint64_t unsaid = 0;  // begins since the last line
    std::uint64_t begins = 0;  // as the source counted
    rt::Timestamp began;       // the last time
    rt::Timestamp seen;        // when it last held or was unclear
    Allowance allowance;
  };

  void follow(Entry& entry, const Condition& condition, rt::Timestamp now);
  void report(Entry& entry, rt::Timestamp now, std::vector<JournalLine>& lines);
  static JournalLine lineOf(const Entry& entry, rt::Timestamp now);

  std::map<std::string, Entry> entries_;
  Allowance of_all_{kBurstOfAll, {}};
};

}  // namespace appliance
