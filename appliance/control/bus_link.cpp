#include "appliance/control/bus_link.h"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <utility>

namespace appliance {
namespace {

// Results of RequestName, as the D-Bus specification numbers them.
constexpr std::uint32_t kPrimaryOwner = 1;
constexpr std::uint32_t kAlreadyOwner = 4;

/// Signals pile up in our queue if the bus no longer reads them.
constexpr std::uint64_t kMostQueued = 1000;

/// A call to the bus itself, made while a message is handled, delays the event loop at most so
/// long.
constexpr std::uint64_t kLongestCall_us = 2'000'000;

constexpr const char* kDisconnected =
    "type='signal',sender='org.freedesktop.DBus.Local',path='/org/freedesktop/DBus/Local',"
    "interface='org.freedesktop.DBus.Local',member='Disconnected'";

bool isStuck(sd_bus* bus) {
  std::uint64_t queued = 0;
  return sd_bus_get_n_queued_write(bus, &queued) >= 0 && queued > kMostQueued;
}

}  // namespace

BusLink::BusLink(EventLoop& loop, std::string which, std::string name, Events events)
    : loop_(loop), which_(std::move(which)), name_(std::move(name)), events_(std::move(events)) {}

BusLink::~BusLink() = default;

void BusLink::look(rt::Timestamp now) {
  if (bus_ && !owns_name_ && !failed_ && now >= patience_ends_)
    fail(phrase<Word::kBusSilent>(describeBus(which_)));
  if (owns_name_ && isStuck(bus_.get())) fail(phrase<Word::kBusStuck>(describeBus(which_)));
  if (failed_) {
    close();
    next_try_ = now + kRetry;
  }
  if (!bus_ && now >= next_try_) connect(now);
}

void BusLink::connect(rt::Timestamp now) {
  auto opened = startBus(which_);
  if (!opened) {
    trouble_ = phrase<Word::kBusUnreachable>(opened.error());
    next_try_ = now + kRetry;
    return;
  }
  bus_ = std::move(*opened);
  patience_ends_ = now + kPatience;
  sd_bus* bus = bus_.get();
  const auto on_loss = [](sd_bus_message*, void* link, sd_bus_error*) {
    auto& self = *static_cast<BusLink*>(link);
    self.fail(phrase<Word::kBusLost>(describeBus(self.which_)));
    return 0;
  };
  const auto on_name = [](sd_bus_message* reply, void* link, sd_bus_error*) {
    static_cast<BusLink*>(link)->onName(reply);
    return 0;
  };
  (void)sd_bus_set_method_call_timeout(bus, kLongestCall_us);
  int r = sd_bus_add_match(bus, nullptr, kDisconnected, on_loss, this);
  if (r >= 0) r = events_.offer(bus);
  if (r >= 0) r = sd_bus_attach_event(bus, loop_.handle(), EventLoop::kBusPriority);
  if (r >= 0) r = sd_bus_request_name_async(bus, nullptr, name_.c_str(), 0, on_name, this);
  if (r < 0) fail(phrase<Word::kBusNameInvalid>(title(), std::strerror(-r)));
}

void BusLink::onName(sd_bus_message* reply) {
  if (const sd_bus_error* error = sd_bus_message_get_error(reply); error != nullptr) {
    const char* why = error->message != nullptr ? error->message : error->name;
    fail(phrase<Word::kBusNameRefused>(title(), why));
    return;
  }
  std::uint32_t result = 0;
  if (sd_bus_message_read(reply, "u", &result) < 0) result = 0;
  if (result != kPrimaryOwner && result != kAlreadyOwner) {
    fail(phrase<Word::kBusNameTaken>(name_, describeBus(which_)));
    return;
  }
  owns_name_ = true;
  trouble_ = {};
}

/// The first trouble of a connection is its cause; what follows from it says less.
void BusLink::fail(const Phrase& trouble) {
  if (failed_) return;
  failed_ = true;
  trouble_ = trouble;
}

void BusLink::close() {
  const bool had_callers = std::exchange(owns_name_, false);
  failed_ = false;
  bus_.reset();
  if (had_callers) events_.lost();
}

}  // namespace appliance
