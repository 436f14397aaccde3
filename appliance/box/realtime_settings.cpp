#include "appliance/box/realtime_settings.h"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "appliance/config/section.h"

namespace appliance {
namespace {

constexpr std::array<std::string_view, 3> kPolicies = {"other", "fifo", "rr"};

void readSchedule(Section section, ThreadSchedule& schedule) {
  section.choice("policy", schedule.policy, kPolicies);
  section.integer("priority", schedule.priority, {0, 99});
  const std::vector<std::int64_t> cpus = section.named("cpus").integerListOr(
      "cpus", {schedule.cpus.begin(), schedule.cpus.end()}, {0, 1023, "(CPU numbers)"});
  schedule.cpus.assign(cpus.begin(), cpus.end());
  section.end();
  const bool realtime = schedule.policy != rt::SchedPolicy::kOther;
  if (realtime && schedule.priority == 0)
    section.fail("priority", "priority must be 1 to 99 under the policies fifo and rr");
  if (!realtime && schedule.priority != 0)
    section.fail("priority", "priority must be 0 under the policy other");
}

}  // namespace

void read(Section section, RealtimeSettings& realtime) {
  section.flag("lock_memory", realtime.lock_memory);
  section.flag("require", realtime.require);
  readSchedule(section.sub("trigger"), realtime.trigger);
  readSchedule(section.sub("receive"), realtime.receive);
  readSchedule(section.sub("render"), realtime.render);
  readSchedule(section.sub("draw"), realtime.draw);
  readSchedule(section.sub("panel"), realtime.panel);
  section.end();
}

}  // namespace appliance
