#include "rt/limits.h"

#include <fstream>

#include <linux/capability.h>
#include <sys/resource.h>

namespace rt {
namespace {

std::uint64_t softLimit(__rlimit_resource_t resource) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0) return 0;
  return limit.rlim_cur == RLIM_INFINITY ? Limits::kUnlimited : limit.rlim_cur;
}

/// The effective capabilities as a bit set; 0 when /proc is not there.
std::uint64_t effectiveCapabilities() {
  std::ifstream status("/proc/self/status");
  for (std::string key; status >> key;) {
    std::uint64_t bits = 0;
    if (key == "CapEff:" && status >> std::hex >> bits) return bits;
  }
  return 0;
}

std::string amount(std::uint64_t value, const char* unit) {
  return value == Limits::kUnlimited ? "unlimited" : std::to_string(value) + unit;
}

}  // namespace

Limits readLimits() {
  const std::uint64_t capabilities = effectiveCapabilities();
  const auto has = [capabilities](int bit) { return ((capabilities >> bit) & 1U) != 0; };
  return {.memlock_bytes = softLimit(RLIMIT_MEMLOCK),
          .rt_priority = softLimit(RLIMIT_RTPRIO),
          .may_lock_any_amount = has(CAP_IPC_LOCK),
          .may_schedule_any = has(CAP_SYS_NICE)};
}

std::string toString(const Limits& limits) {
  std::string line = "RLIMIT_MEMLOCK " + amount(limits.memlock_bytes, " bytes");
  if (limits.may_lock_any_amount) line += " (not binding: CAP_IPC_LOCK)";
  line += ", RLIMIT_RTPRIO " + amount(limits.rt_priority, "");
  if (limits.may_schedule_any) line += " (not binding: CAP_SYS_NICE)";
  return line;
}

}  // namespace rt
