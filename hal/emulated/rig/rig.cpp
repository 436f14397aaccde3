#include "hal/emulated/rig/rig.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <vector>

#include <arpa/inet.h>
#include <sched.h>
#include <sys/epoll.h>
#include <sys/socket.h>

#include "hal/emulated/rig/camera.h"
#include "hal/emulated/rig/device_xml.h"
#include "hal/emulated/rig/gvcp.h"
#include "hal/emulated/rig/socket.h"
#include "hal/emulated/rig/trigger_wire.h"

namespace emulator {
namespace {

constexpr std::uint32_t kLoopback = 0x7f00'0001;
constexpr std::uint32_t kEverybody = 0xffff'ffff;
constexpr std::uint32_t kSubnetMask = 0xff00'0000;
constexpr rt::Nanoseconds kLongestSleep = std::chrono::seconds(1);
constexpr int kMaxEvents = 64;

enum Source : std::uint64_t { kBroadcast = 1u << 20, kWire, kSignal, kFaults };

rt::Nanoseconds optoDelay(const std::vector<double>& delays_us, std::uint32_t camera) {
  if (delays_us.empty()) return rt::Nanoseconds{0};
  return rt::Nanoseconds{std::llround(delays_us[camera] * 1e3)};
}

void sendAnswer(int fd, const sockaddr_in& to, std::span<const std::uint8_t> answer) {
  // An answer that does not go out is asked for again: GVCP runs on UDP.
  (void)::sendto(fd, answer.data(), answer.size(), 0, reinterpret_cast<const sockaddr*>(&to),
                 sizeof to);
}

}  // namespace

struct Rig::State {
  State(Scene& scene, const RigOptions& given)
      : options(given),
        xml(makeDeviceXml(given.max_packet_bytes)),
        loss(given.loss, given.seed),
        context{.scene = scene,
                .counters = record.counters,
                .lateness = record.lateness,
                .loss = loss,
                .wire_log = nullptr,
                .link_bits_per_second = given.link_bits_per_second,
                .max_packet_bytes = given.max_packet_bytes,
                .xml = xml} {
    record.warm_up = given.warm_up;
    warming_up = given.warm_up > rt::Nanoseconds{0};
  }

  std::expected<void, std::string> open();
  std::expected<void, std::string> openCamera(std::uint32_t number);
  std::expected<void, std::string> openFaults();
  void watch(int fd, std::uint64_t source) const;
  void receive(std::uint64_t source, rt::Timestamp now);
  void receiveControl(int fd, Camera& camera, rt::Timestamp now);
  void receiveBroadcast(rt::Timestamp now);
  void receiveWire(rt::Timestamp now);
  void receiveFaults();
  void onEdge(const WireEdge& edge);
  void fireInternal(rt::Timestamp now);
  void enterRealtime() const;

  RigOptions options;
  std::string xml;
  RunRecord record;
  bool warming_up = false;
  LossModel loss;
  std::optional<WireLog> wire_log;
  std::optional<FaultLog> fault_log;
  std::optional<FaultPort> fault_port;
  RigContext context;
  UniqueFd epoll;
  UniqueFd broadcast;
  UniqueFd wire;
  std::vector<UniqueFd> control;
  std::vector<UniqueFd> streams;
  std::vector<Camera> cameras;
  rt::Timestamp first_edge;
  rt::Timestamp last_edge;
  rt::Timestamp next_internal = rt::Timestamp::max();
  std::array<std::uint8_t, 2048> datagram;
};

std::expected<void, std::string> Rig::State::open() {
  epoll = UniqueFd(::epoll_create1(EPOLL_CLOEXEC));
  if (epoll.get() < 0) {
    return std::unexpected(std::string("cannot create the event loop: ") + std::strerror(errno));
  }

  auto wire_socket = bindUdp(kLoopback, options.wire_port, false);
  if (!wire_socket) return std::unexpected("trigger wire: " + wire_socket.error());
  wire = std::move(*wire_socket);
  watch(wire.get(), kWire);

  const std::uint32_t count = context.scene.cameraCount();
  if (const std::size_t delays = options.opto_delays_us.size(); delays != 0 && delays != count) {
    return std::unexpected("--opto-delays-us: " + std::to_string(delays) + " delays for " +
                           std::to_string(count) + " cameras: give one per camera");
  }
  control.reserve(count);
  streams.reserve(count);
  cameras.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (auto opened = openCamera(i); !opened) return opened;
  }
  // Only discovery needs it, and cameras are opened by address: without it all else works.
  if (auto socket = bindUdp(kEverybody, gvcp::kPort, true)) {
    broadcast = std::move(*socket);
    watch(broadcast.get(), kBroadcast);
  } else {
    std::fprintf(stderr, "kagami-emulator: discovery by broadcast is off: %s\n",
                 socket.error().c_str());
  }
  if (!options.wire_log.empty()) {
    auto log = WireLog::open(options.wire_log);
    if (!log) return std::unexpected(log.error());
    wire_log = std::move(*log);
    context.wire_log = &*wire_log;
  }
  return openFaults();
}

std::expected<void, std::string> Rig::State::openFaults() {
  if (!options.fault_log.empty()) {
    auto log = FaultLog::open(options.fault_log);
    if (!log) return std::unexpected(log.error());
    fault_log = std::move(*log);
    context.fault_log = &*fault_log;
  }
  if (options.fault_port == 0) return {};
  auto port = FaultPort::open(options.first_address, options.fault_port);
  if (!port) return std::unexpected(port.error());
  fault_port = std::move(*port);
  watch(fault_port->fd(), kFaults);
  return {};
}

std::expected<void, std::string> Rig::State::openCamera(std::uint32_t number) {
  const std::uint32_t address = options.first_address + number;
  const std::string who = "camera " + std::to_string(number + 1) + ": ";
  auto control_socket = bindUdp(address, gvcp::kPort, false);
  if (!control_socket) return std::unexpected(who + control_socket.error());
  auto stream_socket = bindUdp(address, 0, false);
  if (!stream_socket) return std::unexpected(who + stream_socket.error());
  watch(control_socket->get(), number);
  const Identity identity{.number = number,
                          .address = address,
                          .subnet_mask = kSubnetMask,
                          .user_name = context.scene.cameraName(number),
                          .sensor = context.scene.sensorSize(number),
                          .opto_delay = optoDelay(options.opto_delays_us, number)};
  cameras.emplace_back(identity, stream_socket->get(), context);
  control.push_back(std::move(*control_socket));
  streams.push_back(std::move(*stream_socket));
  return {};
}

void Rig::State::watch(int fd, std::uint64_t source) const {
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.u64 = source;
  ::epoll_ctl(epoll.get(), EPOLL_CTL_ADD, fd, &event);
}

void Rig::State::receive(std::uint64_t source, rt::Timestamp now) {
  if (source == kWire) {
    receiveWire(now);
  } else if (source == kBroadcast) {
    receiveBroadcast(now);
  } else if (source == kFaults) {
    receiveFaults();
  } else if (source < cameras.size()) {
    receiveControl(control[source].get(), cameras[source], now);
  }
}

void Rig::State::receiveControl(int fd, Camera& camera, rt::Timestamp now) {
  sockaddr_in from{};
  socklen_t length = sizeof from;
  ssize_t bytes = 0;
  while ((bytes = ::recvfrom(fd, datagram.data(), datagram.size(), 0,
                             reinterpret_cast<sockaddr*>(&from), &length)) >= 0) {
    camera.onControl({datagram.data(), static_cast<std::size_t>(bytes)}, from, now,
                     [&](std::span<const std::uint8_t> answer) { sendAnswer(fd, from, answer); });
    length = sizeof from;
  }
}

/// Everybody hears a broadcast; each camera answers from its own address.
void Rig::State::receiveBroadcast(rt::Timestamp now) {
  sockaddr_in from{};
  socklen_t length = sizeof from;
  ssize_t bytes = 0;
  while ((bytes = ::recvfrom(broadcast.get(), datagram.data(), datagram.size(), 0,
                             reinterpret_cast<sockaddr*>(&from), &length)) >= 0) {
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      cameras[i].onControl({datagram.data(), static_cast<std::size_t>(bytes)}, from, now,
                           [&](std::span<const std::uint8_t> answer) {
                             sendAnswer(control[i].get(), from, answer);
                           });
    }
    length = sizeof from;
  }
}

void Rig::State::receiveWire(rt::Timestamp now) {
  ssize_t bytes = 0;
  while ((bytes = ::recv(wire.get(), datagram.data(), datagram.size(), 0)) >= 0) {
    const auto edge = parseWireEdge(
        {reinterpret_cast<const char*>(datagram.data()), static_cast<std::size_t>(bytes)});
    if (edge && std::chrono::abs(edge->at - now) <= kLongestWireDelay) {
      onEdge(*edge);
    } else if (record.counters.wire_errors++ == 0) {
      std::fputs(
          "kagami-emulator: the trigger wire carried a datagram that is no edge of now; edges read "
          "\"L1+ <monotonic ns>\" or \"L1- <monotonic ns>\"; such datagrams are ignored\n",
          stderr);
    }
  }
}

void Rig::State::receiveFaults() {
  fault_port->serve(static_cast<std::uint32_t>(cameras.size()), [this](const FaultCommand& fault) {
    ++record.counters.faults_commanded;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      if (fault.camera.value_or(i) == i) cameras[i].applyFault(fault, rt::now());
    }
  });
}

void Rig::State::onEdge(const WireEdge& edge) {
  Counters& counters = record.counters;
  if (edge.rising) {
    if (counters.triggers++ == 0) first_edge = edge.at;
    last_edge = edge.at;
    if (warming_up && edge.at - first_edge >= record.warm_up) {
      warming_up = false;
      record.endWarmUp();
    }
    context.scene.onTrigger(counters.triggers, edge.at);
  }
  for (Camera& camera : cameras) camera.onLine1(edge.rising, edge.at, counters.triggers);
}

void Rig::State::fireInternal(rt::Timestamp now) {
  const rt::Nanoseconds period{static_cast<std::int64_t>(1e9 / options.internal_trigger_hz)};
  while (next_internal <= now) {
    onEdge({.rising = true, .at = next_internal});
    onEdge({.rising = false, .at = next_internal});
    next_internal += period;
  }
}

void Rig::State::enterRealtime() const {
  if (options.realtime_priority == 0) return;
  const sched_param priority{options.realtime_priority};
  if (::sched_setscheduler(0, SCHED_FIFO, &priority) != 0) {
    std::fprintf(stderr,
                 "kagami-emulator: no permission for SCHED_FIFO priority %d (%s): runs with "
                 "ordinary scheduling; raise the limit with ulimit -r or run as root\n",
                 options.realtime_priority, std::strerror(errno));
  }
}

Rig::Rig(std::unique_ptr<State> state) : state_(std::move(state)) {}
Rig::Rig(Rig&&) noexcept = default;
Rig& Rig::operator=(Rig&&) noexcept = default;
Rig::~Rig() = default;

std::expected<Rig, std::string> Rig::open(Scene& scene, const RigOptions& options) {
  auto state = std::make_unique<State>(scene, options);
  if (auto opened = state->open(); !opened) return std::unexpected(opened.error());
  return Rig(std::move(state));
}

std::expected<void, std::string> Rig::run(const rt::StopSignals& stop) {
  State& s = *state_;
  s.watch(stop.fd(), kSignal);
  s.enterRealtime();
  const rt::Timestamp start = rt::now();
  const auto end = s.options.run_for ? start + *s.options.run_for : rt::Timestamp::max();
  if (s.options.internal_trigger_hz > 0) s.next_internal = start;

  while (true) {
    rt::Timestamp deadline = std::min({end, s.next_internal, rt::now() + kLongestSleep});
    for (const Camera& camera : s.cameras) deadline = std::min(deadline, camera.nextDeadline());
    const auto sleep = std::max(deadline - rt::now(), rt::Nanoseconds{0}).count();
    const timespec timeout{sleep / 1'000'000'000, sleep % 1'000'000'000};
    std::array<epoll_event, kMaxEvents> events;
    const int count = ::epoll_pwait2(s.epoll.get(), events.data(), kMaxEvents, &timeout, nullptr);
    if (count < 0 && errno != EINTR) {
      return std::unexpected(std::string("the event loop failed: ") + std::strerror(errno));
    }
    const rt::Timestamp now = rt::now();
    for (int i = 0; i < count; ++i) {
      if (events[static_cast<std::size_t>(i)].data.u64 == kSignal) return {};
      s.receive(events[static_cast<std::size_t>(i)].data.u64, now);
    }
    if (now >= end) return {};
    s.fireInternal(now);
    for (Camera& camera : s.cameras) camera.advance(rt::now());
  }
}

const RunRecord& Rig::record() const {
  return state_->record;
}

rt::Nanoseconds Rig::triggerPeriod() const {
  if (state_->record.counters.triggers < 2) return rt::Nanoseconds{0};
  return (state_->last_edge - state_->first_edge) /
         static_cast<std::int64_t>(state_->record.counters.triggers - 1);
}

}  // namespace emulator
