#include "appliance/box/part_list.h"

#include <future>
#include <ranges>
#include <thread>
#include <utility>

namespace appliance {
namespace {

/// A part whose thread still uses it stays until the process ends.
void abandon(std::unique_ptr<Part> part) {
  static auto* const abandoned = new std::vector<std::unique_ptr<Part>>;  // never destroyed
  abandoned->push_back(std::move(part));
}

}  // namespace

PartList::~PartList() {
  (void)stop();
  while (!parts_.empty()) parts_.pop_back();  // the vector's destructor would begin with the first
}

std::expected<void, std::string> PartList::start() {
  for (const auto& part : parts_) {
    auto started = part->start();
    if (started) continue;
    std::string why = std::move(started.error());
    for (const std::string& hung : stop()) why += "; " + hung;
    return std::unexpected(std::move(why));
  }
  return {};
}

std::vector<std::string> PartList::stop() {
  std::vector<std::string> hung;
  if (std::exchange(stopped_, true)) return hung;
  for (std::unique_ptr<Part>& part : std::views::reverse(parts_)) {
    if (stopInTime(*part)) continue;
    hung.push_back(withId(
        phrase<Word::kPartHangs>(part->name(), std::chrono::duration<double>(patience_).count())));
    abandon(std::move(part));
  }
  std::erase(parts_, nullptr);
  hung_ = !hung.empty();
  return hung;
}

bool PartList::stopInTime(Part& part) const {
  std::packaged_task<void()> task([&part] { part.stop(); });
  const std::future<void> done = task.get_future();
  std::thread stopper(std::move(task));
  if (done.wait_for(patience_) != std::future_status::ready) {
    stopper.detach();
    return false;
  }
  stopper.join();
  return true;
}

void PartList::report(Status& status) const {
  for (const auto& part : parts_) part->report(status);
}

void PartList::addBusObjects(std::vector<BusObject>& objects) const {
  for (const auto& part : parts_) part->addBusObjects(objects);
}

std::expected<void, std::string> PartList::handle(const Request& request) {
  for (const auto& part : parts_)
    if (const Answer answer = part->handle(request)) return *answer;
  return std::unexpected(withId(phrase<Word::kNoSuchRequest>(request.verb)));
}

}  // namespace appliance
