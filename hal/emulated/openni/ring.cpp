#include "hal/emulated/openni/ring.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <linux/futex.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "hal/emulated/openni/ring_layout.h"
#include "rt/unique_fd.h"

namespace emulator {
namespace {

constexpr std::uint32_t kLargestSide_px = 4096;

std::string because(const std::string& path, const char* what) {
  return "depth ring " + path + ": " + what + " (" + std::strerror(errno) + ")";
}

/// One mapped ring. The writer keeps its file locked, so the reader learns from the kernel when
/// the writer dies.
struct MappedRing {
  rt::UniqueFd fd;
  std::byte* bytes = nullptr;
  std::size_t size = 0;

  MappedRing() = default;
  MappedRing(const MappedRing&) = delete;
  MappedRing& operator=(const MappedRing&) = delete;
  ~MappedRing() {
    if (bytes != nullptr) ::munmap(bytes, size);
  }

  [[nodiscard]] bool map(std::size_t length, int protection) {
    void* at = ::mmap(nullptr, length, protection, MAP_SHARED, fd.get(), 0);
    if (at == MAP_FAILED) return false;
    bytes = static_cast<std::byte*>(at);
    size = length;
    return true;
  }
  [[nodiscard]] DepthRingHead& head() const { return *reinterpret_cast<DepthRingHead*>(bytes); }
  [[nodiscard]] std::byte* slotAt(std::uint64_t number) const {
    return bytes + kDepthRingHeadBytes +
           (number % DepthRingWriter::kSlots) * slotBytes(head().format);
  }
  [[nodiscard]] DepthRingHead::Slot& slotOf(std::uint64_t number) const {
    return head().slot[number % DepthRingWriter::kSlots];
  }
};

bool plausible(const RgbdFormat& format) {
  const auto side = [](std::uint32_t px) { return px >= 16 && px <= kLargestSide_px; };
  return side(format.width_px) && side(format.height_px) && format.rate_hz >= 1 &&
         format.rate_hz <= 1000 && format.focal_px > 0;
}

/// Copies what the writer may be overwriting: every load is an acquire, so that the look at the
/// slot's number that follows is not done before them.
void copyShared(void* to, const std::byte* from, std::size_t bytes) {
  using Word = std::uint32_t;
  auto* out = static_cast<std::byte*>(to);
  auto* in = const_cast<std::byte*>(from);  // atomic_ref only reads it
  std::size_t done = 0;
  for (; done + sizeof(Word) <= bytes; done += sizeof(Word)) {
    const std::atomic_ref<Word> word(*reinterpret_cast<Word*>(in + done));
    const Word value = word.load(std::memory_order_acquire);
    std::memcpy(out + done, &value, sizeof value);
  }
  for (; done < bytes; ++done) {
    const std::atomic_ref<std::byte> last(in[done]);
    out[done] = last.load(std::memory_order_acquire);
  }
}

}  // namespace

std::string depthRingPath() {
  const char* path = std::getenv("KAGAMI_DEPTH_RING");
  return path != nullptr && *path != '\0' ? path : "/dev/shm/kagami-depth";
}

struct DepthRingWriter::Mapping : MappedRing {
  std::string path;
  std::uint64_t drawing = 0;
};

DepthRingWriter::DepthRingWriter(std::unique_ptr<Mapping> mapping) : mapping_(std::move(mapping)) {}
DepthRingWriter::DepthRingWriter(DepthRingWriter&& other) noexcept = default;
DepthRingWriter& DepthRingWriter::operator=(DepthRingWriter&& other) noexcept = default;

DepthRingWriter::~DepthRingWriter() {
  if (!mapping_) return;
  setPlugged(false);
  ::unlink(mapping_->path.c_str());
}

std::expected<DepthRingWriter, std::string> DepthRingWriter::create(const std::string& path,
                                                                    const RgbdFormat& format) {
  if (!plausible(format)) {
    return std::unexpected(
        "depth ring " + path + ": pictures of " + std::to_string(format.width_px) + "x" +
        std::to_string(format.height_px) + " are not possible: 16 to 4096 px a side");
  }
  if (const rt::UniqueFd old(::open(path.c_str(), O_RDONLY | O_CLOEXEC)); old.valid()) {
    if (::flock(old.get(), LOCK_SH | LOCK_NB) != 0) {
      return std::unexpected("depth ring " + path +
                             ": another emulator writes to it: stop that one, or choose another "
                             "place with KAGAMI_DEPTH_RING");
    }
  }
  auto mapping = std::make_unique<Mapping>();
  // Made beside and moved into place, so that no reader sees half a ring.
  const std::string fresh = path + "." + std::to_string(::getpid());
  mapping->path = path;
  mapping->fd = rt::UniqueFd(::open(fresh.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
  if (!mapping->fd.valid()) return std::unexpected(because(fresh, "cannot be written"));
  const std::size_t bytes = ringBytes(format);
  // fallocate: full shared memory is an error here, not a signal later.
  if (::flock(mapping->fd.get(), LOCK_EX | LOCK_NB) != 0 ||
      ::posix_fallocate(mapping->fd.get(), 0, static_cast<off_t>(bytes)) != 0 ||
      !mapping->map(bytes, PROT_READ | PROT_WRITE)) {
    ::unlink(fresh.c_str());
    return std::unexpected("depth ring " + path + ": no " + std::to_string(bytes / 1'000'000) +
                           " MB of shared memory for it: free some in its folder");
  }
  DepthRingHead& head = mapping->head();
  head.magic = DepthRingHead::kMagic;
  head.version = DepthRingHead::kVersion;
  head.slots = kSlots;
  head.format = format;
  head.plugged.store(1, std::memory_order_release);
  if (::rename(fresh.c_str(), path.c_str()) != 0) {
    ::unlink(fresh.c_str());
    return std::unexpected(because(path, "cannot be put in place"));
  }
  return DepthRingWriter(std::move(mapping));
}

DepthRingWriter::Canvas DepthRingWriter::begin() {
  const DepthRingHead& head = mapping_->head();
  mapping_->drawing = number_ + 1;
  mapping_->slotOf(mapping_->drawing).number.store(0, std::memory_order_seq_cst);
  std::byte* at = mapping_->slotAt(mapping_->drawing);
  Canvas canvas{.depth_m = {reinterpret_cast<float*>(at), head.format.pixels()}, .colour_rgb = {}};
  if (head.format.colour) {
    canvas.colour_rgb = {reinterpret_cast<std::uint8_t*>(at + depthBytes(head.format)),
                         head.format.pixels() * 3};
  }
  return canvas;
}

std::uint64_t DepthRingWriter::publish(rt::Timestamp exposure) {
  DepthRingHead& head = mapping_->head();
  if (mapping_->drawing != number_ + 1) (void)begin();
  number_ = mapping_->drawing;
  DepthRingHead::Slot& slot = mapping_->slotOf(number_);
  slot.exposure_ns.store(rt::toNs(exposure), std::memory_order_relaxed);
  slot.number.store(number_, std::memory_order_release);
  head.newest.store(number_, std::memory_order_release);
  head.bell.fetch_add(1, std::memory_order_release);
  ::syscall(SYS_futex, &head.bell, FUTEX_WAKE, INT32_MAX, nullptr, nullptr, 0);
  return number_;
}

void DepthRingWriter::setPlugged(bool plugged) {
  mapping_->head().plugged.store(plugged ? 1 : 0, std::memory_order_release);
}

struct DepthRingReader::Mapping : MappedRing {};

DepthRingReader::DepthRingReader(std::unique_ptr<Mapping> mapping) : mapping_(std::move(mapping)) {}
DepthRingReader::DepthRingReader(DepthRingReader&& other) noexcept = default;
DepthRingReader& DepthRingReader::operator=(DepthRingReader&& other) noexcept = default;
DepthRingReader::~DepthRingReader() = default;

std::expected<DepthRingReader, std::string> DepthRingReader::open(const std::string& path) {
  auto mapping = std::make_unique<Mapping>();
  mapping->fd = rt::UniqueFd(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!mapping->fd.valid()) return std::unexpected(because(path, "cannot be read"));
  struct stat facts{};
  if (::fstat(mapping->fd.get(), &facts) != 0 || facts.st_size <= off_t{kDepthRingHeadBytes} ||
      !mapping->map(static_cast<std::size_t>(facts.st_size), PROT_READ)) {
    return std::unexpected("depth ring " + path + ": not a ring: remove it");
  }
  const DepthRingHead& head = mapping->head();
  if (head.magic != DepthRingHead::kMagic || head.version != DepthRingHead::kVersion ||
      head.slots != DepthRingWriter::kSlots || !plausible(head.format) ||
      mapping->size != ringBytes(head.format)) {
    return std::unexpected("depth ring " + path +
                           ": not one of this version: are emulator and driver of one build?");
  }
  return DepthRingReader(std::move(mapping));
}

const RgbdFormat& DepthRingReader::format() const {
  return mapping_->head().format;
}

std::uint64_t DepthRingReader::newest() const {
  return mapping_->head().newest.load(std::memory_order_acquire);
}

bool DepthRingReader::plugged() const {
  if (mapping_->head().plugged.load(std::memory_order_acquire) == 0) return false;
  if (::flock(mapping_->fd.get(), LOCK_SH | LOCK_NB) != 0) return true;  // the writer holds it
  ::flock(mapping_->fd.get(), LOCK_UN);
  return false;
}

void DepthRingReader::waitAfter(std::uint64_t number, rt::Nanoseconds timeout) const {
  const DepthRingHead& head = mapping_->head();
  const std::uint32_t heard = head.bell.load(std::memory_order_acquire);
  if (newest() > number) return;
  const auto ns = std::max<std::int64_t>(timeout.count(), 0);
  const timespec limit{.tv_sec = ns / 1'000'000'000, .tv_nsec = ns % 1'000'000'000};
  ::syscall(SYS_futex, &head.bell, FUTEX_WAIT, heard, &limit, nullptr, 0);
}

std::optional<DepthRingReader::Stamp> DepthRingReader::stamp(std::uint64_t number) const {
  const DepthRingHead::Slot& slot = mapping_->slotOf(number);
  if (number == 0 || slot.number.load(std::memory_order_acquire) != number) return std::nullopt;
  const std::int64_t exposure_ns = slot.exposure_ns.load(std::memory_order_acquire);
  if (slot.number.load(std::memory_order_relaxed) != number) return std::nullopt;
  return Stamp{number, rt::fromNs(exposure_ns)};
}

bool DepthRingReader::read(std::uint64_t number, std::span<float> depth_m,
                           std::span<std::uint8_t> colour_rgb) const {
  const DepthRingHead& head = mapping_->head();
  if (!stamp(number)) return false;
  const std::byte* at = mapping_->slotAt(number);
  copyShared(depth_m.data(), at, std::min(depth_m.size_bytes(), depthBytes(head.format)));
  if (head.format.colour) {
    copyShared(colour_rgb.data(), at + depthBytes(head.format),
               std::min(colour_rgb.size_bytes(), head.format.pixels() * 3));
  }
  return stamp(number).has_value();
}

}  // namespace emulator
