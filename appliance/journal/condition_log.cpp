#include "appliance/journal/condition_log.h"

#include <algorithm>
#include <utility>

#include "appliance/words/phrase.h"

namespace appliance {
namespace {

std::string lasted(rt::Nanoseconds time) {
  return " " + textOf(phrase<Word::kLasted>(std::chrono::duration<double>(time).count()));
}

std::string timesSince(std::uint64_t begins) {
  return " " + textOf(phrase<Word::kTimesSince>(begins));
}

}  // namespace

bool ConditionLog::Allowance::take(rt::Timestamp now, double burst, rt::Nanoseconds refill) {
  const double refilled = std::chrono::duration<double>(now - counted_at).count() /
                          std::chrono::duration<double>(refill).count();
  lines = std::min(burst, lines + refilled);
  counted_at = now;
  if (lines < 1) return false;
  lines -= 1;
  return true;
}

std::vector<JournalLine> ConditionLog::look(rt::Timestamp now,
                                            std::span<const Condition> conditions) {
  for (auto& [key, entry] : entries_) {
    const auto named = std::ranges::find(conditions, key, &Condition::key);
    if (named == conditions.end()) entry.holds = false;
  }
  for (const Condition& condition : conditions) {
    const auto known = entries_.find(condition.key);
    if (known != entries_.end()) {
      follow(known->second, condition, now);
    } else if (condition.now == Condition::Now::kHolds) {
      Entry entry{.last = {}, .allowance = {kBurst, now}};
      follow(entry, condition, now);
      entry.unsaid = 1;  // what began before the first look is one begin
      entries_.emplace(condition.key, std::move(entry));
    }
  }
  std::vector<JournalLine> lines;
  for (auto& [key, entry] : entries_) report(entry, now, lines);
  std::erase_if(entries_, [this, now](const auto& known) {
    const Entry& entry = known.second;
    const bool settled = !entry.holds && !entry.said && entry.unsaid == 0;
    return (settled && now - entry.seen >= kForgetAfter) ||
           (!entry.holds && entries_.size() > kMostRemembered);
  });
  return lines;
}

void ConditionLog::follow(Entry& entry, const Condition& condition, rt::Timestamp now) {
  const bool held =
      std::exchange(entry.holds, condition.now == Condition::Now::kHolds ||
                                     (condition.now == Condition::Now::kUnclear && entry.holds));
  if (entry.holds) entry.seen = now;
  const std::uint64_t before = std::exchange(entry.begins, condition.begins);
  const std::uint64_t counted = condition.begins > before ? condition.begins - before : 0;
  if (condition.now != Condition::Now::kHolds) {
    entry.unsaid += counted;
    if (condition.end.empty()) return;
    entry.last.end = condition.end;
    entry.last.end_word = condition.end_word;
    return;
  }
  const bool begins = !held || entry.last.kind != condition.kind;
  if (begins) entry.began = now;
  entry.unsaid += condition.begins == 0 ? (begins ? 1 : 0) : counted;
  entry.last = condition;
}

void ConditionLog::report(Entry& entry, rt::Timestamp now, std::vector<JournalLine>& lines) {
  const bool as_said =
      entry.holds == entry.said && (!entry.holds || entry.last.kind == entry.said_kind);
  if (as_said && entry.unsaid == 0) return;
  if (!entry.allowance.take(now, kBurst, kRefill)) return;
  if (!of_all_.take(now, kBurstOfAll, kRefillOfAll)) return;
  lines.push_back(lineOf(entry, now));
  entry.said = entry.holds;
  entry.said_kind = entry.last.kind;
  entry.unsaid = 0;
}

JournalLine ConditionLog::lineOf(const Entry& entry, rt::Timestamp now) {
  const Condition& condition = entry.last;
  if (entry.holds) {
    return {condition.level,
            condition.text + (entry.unsaid > 1 ? timesSince(entry.unsaid) : std::string()),
            condition.word};
  }
  if (entry.unsaid > 0) {  // it began and ended since the last line
    return {condition.level,
            condition.text + timesSince(entry.unsaid) + "; " + textOf(phrase<Word::kOverNow>()),
            condition.word};
  }
  return {condition.end_level, condition.end + lasted(now - entry.began), condition.end_word};
}

}  // namespace appliance
