#include "appliance/journal/loss_log.h"

#include <utility>

namespace appliance {

std::optional<std::uint64_t> LossLog::look(rt::Timestamp now, const std::string& key,
                                           std::uint64_t total, bool counts) {
  Seen& seen = seen_[key];
  const std::uint64_t before = std::exchange(seen.total, total);
  if (!counts) return std::nullopt;
  if (total > before) seen.unsaid += total - before;
  const bool said_lately = seen.said_at && now - *seen.said_at < kPeriod;
  if (seen.unsaid == 0 || said_lately) return std::nullopt;
  seen.said_at = now;
  return std::exchange(seen.unsaid, 0);
}

}  // namespace appliance
