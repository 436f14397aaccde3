// The first process of the test kernel: mounts what a running system has, runs one command and
// hands its exit status out as the kernel's own. Static, because nothing is mounted yet when it
// starts. run_in_kernel.sh calls it; the job file that it reads is described there.

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <fcntl.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/mount.h>
#include <sys/reboot.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

namespace {

constexpr int kBedFailed = 125;  // no status of the command's own

[[noreturn]] void powerOff(int status) {
  const std::string text = std::to_string(status) + "\n";
  const int fd = ::open("/proc/exitcode", O_WRONLY | O_CLOEXEC);
  if (fd >= 0) {
    (void)!::write(fd, text.data(), text.size());
    ::close(fd);
  }
  ::tcdrain(STDOUT_FILENO);
  ::tcdrain(STDERR_FILENO);
  ::sync();
  ::reboot(RB_POWER_OFF);
  ::_exit(status);
}

[[noreturn]] void fail(const std::string& what) {
  std::fprintf(stderr, "bed: %s: %s\n", what.c_str(), std::strerror(errno));
  std::fflush(stderr);
  powerOff(kBedFailed);
}

struct Mount {
  const char* source;
  const char* target;
  const char* type;
  const char* options;
};

void mountOne(const Mount& mount) {
  ::mkdir(mount.target, 0755);  // those in sysfs are there already
  if (::mount(mount.source, mount.target, mount.type, 0, mount.options) != 0) {
    fail(std::string("mount ") + mount.target);
  }
}

/// A console of the kernel as one of our three streams, every byte as it is.
void openConsole(const char* device, int stream) {
  const int fd = ::open(device, O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (fd < 0) return;
  termios settings{};
  if (::tcgetattr(fd, &settings) == 0) {
    ::cfmakeraw(&settings);
    ::tcsetattr(fd, TCSANOW, &settings);
  }
  ::dup2(fd, stream);
}

/// The host's files, with a layer above them that takes every write and is lost at the end.
void enterOverlay() {
  mountOne({"memory", "/mnt", "tmpfs", "size=75%"});
  for (const char* folder : {"/mnt/upper", "/mnt/work", "/mnt/root"}) ::mkdir(folder, 0755);
  mountOne({"root", "/mnt/root", "overlay", "lowerdir=/,upperdir=/mnt/upper,workdir=/mnt/work"});
  for (const std::string folder : {"/proc", "/dev"}) {
    if (::mount(folder.c_str(), ("/mnt/root" + folder).c_str(), nullptr, MS_MOVE, nullptr) != 0) {
      fail("move " + folder);
    }
  }
  if (::chdir("/mnt/root") != 0 || ::chroot(".") != 0) fail("chroot");
}

void mountTheRest() {
  for (const Mount& mount : {Mount{"sys", "/sys", "sysfs", nullptr},
                             {"config", "/sys/kernel/config", "configfs", nullptr},
                             {"debug", "/sys/kernel/debug", "debugfs", nullptr},
                             {"trace", "/sys/kernel/tracing", "tracefs", nullptr},
                             {"cgroup", "/sys/fs/cgroup", "cgroup2", nullptr},
                             {"pts", "/dev/pts", "devpts", "mode=620,ptmxmode=666"},
                             {"shm", "/dev/shm", "tmpfs", "mode=1777"},
                             {"run", "/run", "tmpfs", "mode=755"}}) {
    mountOne(mount);
  }
  constexpr std::array<std::array<const char*, 2>, 4> kLinks = {{{"/proc/self/fd", "/dev/fd"},
                                                                 {"fd/0", "/dev/stdin"},
                                                                 {"fd/1", "/dev/stdout"},
                                                                 {"fd/2", "/dev/stderr"}}};
  for (const auto& [target, link] : kLinks) (void)!::symlink(target, link);
}

/// Folders of the host that stay writable, separated by colons.
void mountWritable(const std::string& folders) {
  std::istringstream list(folders);
  for (std::string folder; std::getline(list, folder, ':');) {
    std::error_code ignored;
    std::filesystem::create_directories(folder, ignored);
    if (::mount("host", folder.c_str(), "hostfs", 0, folder.c_str()) != 0) fail(folder);
  }
}

void raiseLoopback() {
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) fail("socket");
  ifreq request{};
  std::strcpy(request.ifr_name, "lo");
  if (::ioctl(fd, SIOCGIFFLAGS, &request) != 0) fail("loopback");
  request.ifr_flags = static_cast<short>(request.ifr_flags | IFF_UP);
  if (::ioctl(fd, SIOCSIFFLAGS, &request) != 0) fail("loopback");
  ::close(fd);
}

struct Job {
  std::string folder;
  std::vector<std::string> command;
  std::vector<std::string> environment;
};

Job readJob(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) fail(path);
  Job job;
  std::string count;
  std::getline(file, job.folder, '\0');
  std::getline(file, count, '\0');
  const std::size_t words = std::strtoul(count.c_str(), nullptr, 10);
  for (std::string word; std::getline(file, word, '\0');) {
    (job.command.size() < words ? job.command : job.environment).push_back(word);
  }
  if (job.command.empty() || job.command.size() != words) {
    errno = EINVAL;
    fail(path);
  }
  job.environment.push_back("KAGAMI_KERNEL_BED=1");
  return job;
}

std::vector<char*> pointersTo(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

[[noreturn]] void become(Job job) {
  ::setsid();
  if (::chdir(job.folder.c_str()) != 0) {
    std::fprintf(stderr, "bed: folder %s: %s\n", job.folder.c_str(), std::strerror(errno));
  }
  const std::vector<char*> command = pointersTo(job.command);
  const std::vector<char*> environment = pointersTo(job.environment);
  ::execvpe(command[0], command.data(), environment.data());
  std::fprintf(stderr, "bed: %s: %s\n", command[0], std::strerror(errno));
  ::_exit(errno == ENOENT ? 127 : 126);
}

/// The status of @p child; whatever else ends was left behind by it.
int waitFor(pid_t child) {
  int status = 0;
  for (pid_t ended = 0; ended != child;) {
    ended = ::wait(&status);
    if (ended < 0 && errno != EINTR) fail("wait");
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string fromKernelArguments(const char* name) {
  const char* value = std::getenv(name);  // the kernel hands on what it does not know
  return value != nullptr ? value : "";
}

bool settleAsked() {
  std::ifstream file("/proc/cmdline");
  const std::string line{std::istreambuf_iterator<char>(file), {}};
  return line.find("bed.settle") != std::string::npos;
}

}  // namespace

int main() {
  ::setsid();
  mountOne({"proc", "/proc", "proc", nullptr});
  mountOne({"dev", "/dev", "devtmpfs", "mode=755"});
  openConsole("/dev/tty0", STDOUT_FILENO);
  openConsole("/dev/tty1", STDERR_FILENO);
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  ::dup2(nothing, STDIN_FILENO);

  Job job = readJob(fromKernelArguments("BED_JOB"));
  enterOverlay();
  mountTheRest();
  mountWritable(fromKernelArguments("BED_WRITABLE"));
  raiseLoopback();
  ::sethostname("bed", 3);
  // High-resolution timers come on with the second tick; a test's first timer would be late.
  if (settleAsked()) ::usleep(100'000);

  const pid_t child = ::fork();
  if (child < 0) fail("fork");
  if (child == 0) become(std::move(job));
  powerOff(waitFor(child));
}
