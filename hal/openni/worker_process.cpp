#include "hal/openni/worker_process.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "rt/clock.h"

namespace hal::openni {
namespace {

using namespace std::chrono_literals;

constexpr int kWorkerSocket = 3;
constexpr rt::Nanoseconds kPatience = 500ms;
constexpr std::uint32_t kLargestSide_px = 8192;

struct SpawnSettings {
  posix_spawnattr_t attributes{};
  posix_spawn_file_actions_t actions{};
  /// Neither our blocked signals nor the terminal's Ctrl-C are meant for it.
  explicit SpawnSettings(int socket) {
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, socket, kWorkerSocket);
  }
  ~SpawnSettings() {
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;
};

}  // namespace

std::expected<WorkerProcess, std::string> WorkerProcess::start(
    const std::vector<std::string>& arguments) {
  std::error_code failed;
  const auto program =
      std::filesystem::read_symlink("/proc/self/exe", failed).parent_path() / "kagami-depth";
  if (::access(program.c_str(), X_OK) != 0) {
    return std::unexpected("depth sensor: the program " + program.string() +
                           " is not there: install it beside kagamid");
  }
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0)
    return std::unexpected(std::string("depth sensor: no socket (") + std::strerror(errno) + ")");
  rt::UniqueFd ours(ends[0]);
  rt::UniqueFd theirs(ends[1]);
  if (theirs.get() == kWorkerSocket) {
    // dup2 to itself would leave it close-on-exec: put it elsewhere first.
    theirs = rt::UniqueFd(::fcntl(theirs.get(), F_DUPFD_CLOEXEC, kWorkerSocket + 1));
  }
  std::vector<std::string> words = {program.string(), "worker"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const SpawnSettings settings(theirs.get());
  pid_t pid = -1;
  // Not fork(): a copy of a process with gigabytes locked takes long.
  const int error = ::posix_spawn(&pid, program.c_str(), &settings.actions, &settings.attributes,
                                  argv.data(), environ);
  if (error != 0) {
    return std::unexpected("depth sensor: " + program.string() + " does not start (" +
                           std::strerror(error) + ")");
  }
  return WorkerProcess(pid, std::move(ours));
}

WorkerProcess::WorkerProcess(WorkerProcess&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      socket_(std::move(other.socket_)),
      hello_(other.hello_),
      memory_(std::exchange(other.memory_, nullptr)),
      bytes_(other.bytes_) {}

WorkerProcess& WorkerProcess::operator=(WorkerProcess&& other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(socket_, other.socket_);
  std::swap(hello_, other.hello_);
  std::swap(memory_, other.memory_);
  std::swap(bytes_, other.bytes_);
  return *this;
}

WorkerProcess::~WorkerProcess() {
  if (memory_ != nullptr) ::munmap(memory_, bytes_);
  if (pid_ < 0) return;
  socket_ = rt::UniqueFd();  // it ends when it hears that
  const rt::Timestamp patience = rt::now() + kPatience;
  while (rt::now() < patience) {
    if (::waitpid(pid_, nullptr, WNOHANG) != 0) return;
    std::this_thread::sleep_for(5ms);
  }
  ::kill(pid_, SIGKILL);
  (void)::waitpid(pid_, nullptr, 0);
}

void WorkerProcess::kill() {
  if (pid_ >= 0) ::kill(pid_, SIGKILL);
}

bool WorkerProcess::accept(const WireMessage& hello, rt::UniqueFd memory) {
  const auto side = [](std::uint32_t px) { return px > 0 && px <= kLargestSide_px; };
  if (memory_ != nullptr || !side(hello.width_px) || !side(hello.height_px)) return false;
  const std::size_t bytes = kWireSlots * wireSlotBytes(hello.width_px, hello.height_px);
  struct stat facts{};
  if (::fstat(memory.get(), &facts) != 0 || static_cast<std::size_t>(facts.st_size) < bytes)
    return false;
  // A worker that could shrink it later would end this process by SIGBUS.
  if ((::fcntl(memory.get(), F_GET_SEALS) & F_SEAL_SHRINK) == 0) return false;
  void* at = ::mmap(nullptr, bytes, PROT_READ, MAP_SHARED, memory.get(), 0);
  if (at == MAP_FAILED) return false;
  memory_ = static_cast<std::byte*>(at);
  bytes_ = bytes;
  hello_ = hello;
  return true;
}

std::span<const std::uint16_t> WorkerProcess::depth(std::uint32_t slot) const {
  const std::byte* at = memory_ + slot * wireSlotBytes(hello_.width_px, hello_.height_px);
  return {reinterpret_cast<const std::uint16_t*>(at),
          std::size_t{hello_.width_px} * hello_.height_px};
}

std::span<const std::uint8_t> WorkerProcess::colour(std::uint32_t slot) const {
  const auto before = std::as_bytes(depth(slot));
  return {reinterpret_cast<const std::uint8_t*>(before.data() + before.size()),
          std::size_t{3} * hello_.width_px * hello_.height_px};
}

void WorkerProcess::release(std::uint32_t slot) {
  (void)send(socket_.get(), {.kind = WireMessage::Kind::kRelease, .slot = slot});
}

}  // namespace hal::openni
