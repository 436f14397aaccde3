#include "appliance/control/job_objects.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "appliance/control/bus.h"
#include "appliance/control/bus_callbacks.h"
#include "appliance/control/bus_object.h"
#include "appliance/control/bus_values.h"

namespace appliance {
namespace {

JobId idOf(std::string_view path) {
  const std::string_view number = path.substr(path.rfind('/') + 1);
  JobId id = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), id);
  return error == std::errc() && end == number.data() + number.size() ? id : 0;
}

BusValue valueOf(const JobRegistry::Job& job, std::string_view property) {
  if (property == "Kind") return job.kind;
  if (property == "State") return std::string(nameOf(job.report.state));
  if (property == "Result") return job.report.result;
  return job.report.progress;
}

int getProperty(JobRegistry& jobs, const char* path, const char* property, sd_bus_message* reply) {
  const JobRegistry::Job* job = jobs.find(idOf(path));
  return job == nullptr ? -ENOENT : appendValue(reply, valueOf(*job, property));
}

int onGet(sd_bus* /*bus*/, const char* path, const char* /*interface*/, const char* property,
          sd_bus_message* reply, void* jobs, sd_bus_error* error) noexcept {
  return guarded(
      error, [&] { return getProperty(*static_cast<JobRegistry*>(jobs), path, property, reply); });
}

int cancel(JobRegistry& jobs, sd_bus_message* message, sd_bus_error* error) {
  if (!jobs.cancel(idOf(sd_bus_message_get_path(message))))
    return refuse(error, phrase<Word::kNoSuchJob>());
  return sd_bus_reply_method_return(message, "");
}

/// Whether there is a job of that path.
int onFind(sd_bus* /*bus*/, const char* path, const char* /*interface*/, void* jobs, void** found,
           sd_bus_error* /*error*/) noexcept {
  *found = jobs;
  return static_cast<JobRegistry*>(jobs)->find(idOf(path)) != nullptr ? 1 : 0;
}

/// The paths of all jobs, in memory that sd-bus frees.
int onList(sd_bus* /*bus*/, const char* /*prefix*/, void* jobs, char*** nodes,
           sd_bus_error* error) noexcept {
  return guarded(error, [&] {
    const auto ids = static_cast<JobRegistry*>(jobs)->ids();
    auto** list = static_cast<char**>(std::calloc(ids.size() + 1, sizeof(char*)));
    if (list == nullptr) return -ENOMEM;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      list[i] = strdup(jobPath(ids[i]).c_str());
      if (list[i] != nullptr) continue;
      for (std::size_t j = 0; j < i; ++j) std::free(list[j]);
      std::free(static_cast<void*>(list));
      return -ENOMEM;
    }
    *nodes = list;
    return 1;
  });
}

const auto kTable = std::to_array<sd_bus_vtable>({
    SD_BUS_VTABLE_START(0),
    SD_BUS_PROPERTY("Kind", "s", onGet, 0, SD_BUS_VTABLE_PROPERTY_CONST),
    SD_BUS_PROPERTY("State", "s", onGet, 0, SD_BUS_VTABLE_PROPERTY_EMITS_CHANGE),
    SD_BUS_PROPERTY("Progress", "d", onGet, 0, SD_BUS_VTABLE_PROPERTY_EMITS_CHANGE),
    SD_BUS_PROPERTY("Result", "s", onGet, 0, SD_BUS_VTABLE_PROPERTY_EMITS_CHANGE),
    SD_BUS_METHOD_WITH_ARGS("Cancel", SD_BUS_NO_ARGS, SD_BUS_NO_RESULT,
                            (onMethod<JobRegistry, cancel>), SD_BUS_VTABLE_UNPRIVILEGED),
    SD_BUS_VTABLE_END,
});

}  // namespace

int JobObjects::offer(sd_bus* bus) {
  int r = sd_bus_add_object_manager(bus, nullptr, kControlPath);
  if (r >= 0) r = sd_bus_add_node_enumerator(bus, nullptr, kJobsPath, onList, &jobs_);
  if (r >= 0)
    r = sd_bus_add_fallback_vtable(bus, nullptr, kJobsPath, kJobInterface, kTable.data(), onFind,
                                   &jobs_);
  return r;
}

void JobObjects::tick(sd_bus* bus) {
  const JobRegistry::Changes changes = jobs_.look();
  if (bus == nullptr) return;
  // A failure means a bus that is being lost; the link sees that itself.
  for (const JobId id : changes.begun) {
    (void)sd_bus_emit_object_added(bus, jobPath(id).c_str());
    const std::string owner = jobs_.find(id) != nullptr ? jobs_.find(id)->owner : "";
    // An owner that cannot be watched has left already.
    if (!owner.empty() && peers_.add(bus, owner) < 0) jobs_.ownerLeft(owner);
  }
  for (const JobId id : changes.changed)
    (void)sd_bus_emit_properties_changed(bus, jobPath(id).c_str(), kJobInterface, "State",
                                         "Progress", "Result", nullptr);
  // The object is gone already, so that sd_bus_emit_object_removed() would find no interfaces.
  for (const JobId id : changes.forgotten)
    (void)sd_bus_emit_interfaces_removed(bus, jobPath(id).c_str(), kJobInterface, nullptr);
}

}  // namespace appliance
