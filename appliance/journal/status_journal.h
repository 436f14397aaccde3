#pragma once

#include <span>
#include <vector>

#include "appliance/journal/condition_log.h"
#include "appliance/journal/loss_log.h"
#include "appliance/status/status.h"

namespace appliance {

/// The journal's lines, made from one status after the other.
///
/// Threads  main.
class StatusJournal {
 public:
  /// What is new since the last look. @p more: conditions that no status knows, such as a lost bus.
  [[nodiscard]] std::vector<JournalLine> look(rt::Timestamp now, const Status& status,
                                              std::span<const Condition> more = {});

 private:
  ConditionLog conditions_;
  LossLog losses_;
};

}  // namespace appliance
