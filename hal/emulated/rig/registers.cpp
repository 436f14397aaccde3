#include "hal/emulated/rig/registers.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstring>

#include "hal/emulated/rig/bytes.h"
#include "hal/emulated/rig/device_xml.h"
#include "hal/emulated/rig/features.h"

namespace emulator {
namespace {

using gvcp::Status;

constexpr std::uint32_t kTicksPerSecond = 1'000'000'000;
constexpr std::uint32_t kCapabilities = 1u << 6 | 1u << 2 | 1u << 1 | 1u;  // action, resend, ...
constexpr std::uint32_t kPacketSizeMask = 0xffff;
constexpr std::uint32_t kPowerOnPacketBytes = 1500;

std::uint32_t encode(const Feature& f, double value) {
  return f.kind == FeatureKind::kFloat ? std::bit_cast<std::uint32_t>(static_cast<float>(value))
                                       : static_cast<std::uint32_t>(value);
}

std::uint32_t lastAddress(const Feature& f) {
  return f.index_from.empty() ? f.address : f.address + 8;  // one selector: red, green, blue
}

const Feature* findFeature(std::uint32_t address) {
  const auto all = features();
  const auto found = std::ranges::find_if(all, [address](const Feature& f) {
    return address >= f.address && address <= lastAddress(f);
  });
  return found == all.end() ? nullptr : &*found;
}

bool isInRange(const Feature& f, std::uint32_t value) {
  switch (f.kind) {
    case FeatureKind::kInteger:
      return value >= f.min && value <= f.max && value % f.increment == 0;
    case FeatureKind::kFloat: {
      const auto number = std::bit_cast<float>(value);
      return number >= static_cast<float>(f.min) && number <= static_cast<float>(f.max);
    }
    case FeatureKind::kBoolean:
      return value <= 1;
    case FeatureKind::kEnumeration:
      return std::ranges::any_of(f.entries,
                                 [value](const EnumEntry& e) { return e.value == value; });
    case FeatureKind::kCommand:
      return true;
  }
  return false;
}

}  // namespace

Registers::Registers(const Identity& identity, std::uint32_t max_packet_bytes,
                     std::span<const char> xml)
    : max_packet_bytes_(max_packet_bytes),
      xml_(xml),
      bytes_(kXmlAddress),
      access_(kXmlAddress / 4, Access::kNone) {
  describeBootstrap(identity);
  for (const Feature& f : features()) {
    const auto access = f.kind == FeatureKind::kCommand ? Access::kWrite
                        : f.writable                    ? Access::kReadWrite
                                                        : Access::kRead;
    for (std::uint32_t at = f.address; at <= lastAddress(f); at += 4) {
      allow(at, 4, access);
      set(at, encode(f, f.power_on));
    }
  }
  set(reg::kSensorWidth, identity.sensor.width);
  set(reg::kSensorHeight, identity.sensor.height);
  set(reg::kWidth, identity.sensor.width);
  set(reg::kHeight, identity.sensor.height);
}

void Registers::describeBootstrap(const Identity& identity) {
  const std::uint32_t serial = identity.number + 1;
  allow(0x0000, kDiscoveryBytes, Access::kRead);
  set(0x0000, 0x0001'0002);  // GigE Vision 1.2
  set(0x0004, 0x8000'0001);  // big endian, UTF-8
  set(0x0008, 0x0000'0200);  // a locally administered MAC address ...
  set(0x000c, 0x4b41'0000 | serial);
  set(0x0010, 0x0000'0006);
  set(0x0014, 0x0000'0006);
  set(0x0024, identity.address);
  set(0x0034, identity.subnet_mask);
  setText(0x0048, 32, "Kagami");
  setText(0x0068, 32, "EmulatedCamera");
  setText(0x0088, 32, "1.0");
  setText(0x00a8, 48, "emulated by kagami-emulator");
  char text[64];
  std::snprintf(text, sizeof text, "KAG%05u", serial);
  setText(0x00d8, 16, text);
  setText(reg::kUserName, 16, identity.user_name);
  allow(reg::kUserName, 16, Access::kReadWrite);

  std::snprintf(text, sizeof text, "Local:%s;%x;%zx", kXmlFileName, kXmlAddress, xml_.size());
  allow(0x0200, 512, Access::kRead);
  setText(0x0200, 512, text);
  allow(0x0400, 512, Access::kRead);  // the second description is empty
  allow(0x0600, 4, Access::kRead);
  set(0x0600, 1);  // network interfaces
  allow(0x0900, 0x0a00 - 0x0900, Access::kRead);
  set(0x0904, 1);  // stream channels
  set(0x0934, kCapabilities);
  set(0x0940, kTicksPerSecond);
  allow(reg::kTimestampControl, 4, Access::kWrite);
  allow(reg::kControlPrivilege, 4, Access::kReadWrite);
  allow(reg::kStreamPort, 4, Access::kReadWrite);
  allow(reg::kStreamPacketSize, 4, Access::kReadWrite);
  allow(reg::kStreamDestination, 4, Access::kReadWrite);
  allow(0x0d1c, 4, Access::kRead);  // the stream's source port
  set(reg::kStreamPacketSize, kPowerOnPacketBytes);
}

void Registers::allow(std::uint32_t address, std::uint32_t bytes, Access access) {
  std::fill_n(access_.begin() + address / 4, bytes / 4, access);
}

void Registers::setText(std::uint32_t address, std::size_t capacity, const std::string& text) {
  std::memcpy(&bytes_[address], text.data(), std::min(text.size(), capacity - 1));
}

std::uint32_t Registers::get(std::uint32_t address) const {
  return loadBe32(&bytes_[address]);
}

float Registers::getFloat(std::uint32_t address) const {
  return std::bit_cast<float>(get(address));
}

void Registers::set(std::uint32_t address, std::uint32_t value) {
  storeBe32(&bytes_[address], value);
}

Status Registers::checkRead(std::uint32_t address) const {
  if (address % 4 != 0) return Status::kBadAlignment;
  if (address >= kXmlAddress) return Status::kInvalidAddress;
  const Access access = access_[address / 4];
  return access == Access::kNone || access == Access::kWrite ? Status::kInvalidAddress
                                                             : Status::kSuccess;
}

Status Registers::checkWrite(std::uint32_t address, std::uint32_t value, bool acquiring) const {
  if (address % 4 != 0) return Status::kBadAlignment;
  if (address >= kXmlAddress) return Status::kInvalidAddress;
  switch (access_[address / 4]) {
    case Access::kNone:
      return Status::kInvalidAddress;
    case Access::kRead:
      return Status::kWriteProtect;
    case Access::kReadWrite:
    case Access::kWrite:
      break;
  }
  if (address == reg::kStreamPacketSize) {
    const std::uint32_t bytes = value & kPacketSizeMask;
    if (bytes < kMinPacketBytes || bytes > max_packet_bytes_ || bytes % 4 != 0) {
      return Status::kInvalidParameter;
    }
    return acquiring && bytes != (get(address) & kPacketSizeMask) ? Status::kBusy
                                                                  : Status::kSuccess;
  }
  const Feature* f = findFeature(address);
  if (f == nullptr) return Status::kSuccess;
  if (!isInRange(*f, value)) return Status::kInvalidParameter;
  if (f->locked_by != 0 && get(f->locked_by) != 0) return Status::kWriteProtect;
  if (f->fixed_while_acquiring && acquiring) return Status::kBusy;
  return checkRegion(address, value);
}

Status Registers::checkRegion(std::uint32_t address, std::uint32_t value) const {
  const auto fits = [this](std::uint32_t offset, std::uint32_t length, std::uint32_t sensor) {
    return offset + length <= get(sensor) ? Status::kSuccess : Status::kInvalidParameter;
  };
  switch (address) {
    case reg::kWidth:
      return fits(get(reg::kOffsetX), value, reg::kSensorWidth);
    case reg::kHeight:
      return fits(get(reg::kOffsetY), value, reg::kSensorHeight);
    case reg::kOffsetX:
      return fits(value, get(reg::kWidth), reg::kSensorWidth);
    case reg::kOffsetY:
      return fits(value, get(reg::kHeight), reg::kSensorHeight);
    default:
      return Status::kSuccess;
  }
}

Status Registers::readMemory(std::uint32_t address, std::span<std::uint8_t> out) const {
  if (address % 4 != 0 || out.size() % 4 != 0) return Status::kBadAlignment;
  const std::uint64_t end = std::uint64_t{address} + out.size();
  if (address >= kXmlAddress) {
    const std::uint64_t padded_end = kXmlAddress + (xml_.size() + 3) / 4 * 4;
    if (end > padded_end) return Status::kInvalidAddress;
    const auto from = xml_.subspan(std::min<std::size_t>(address - kXmlAddress, xml_.size()));
    const std::size_t count = std::min(from.size(), out.size());
    std::memcpy(out.data(), from.data(), count);
    std::fill(out.begin() + static_cast<std::ptrdiff_t>(count), out.end(), std::uint8_t{0});
    return Status::kSuccess;
  }
  if (end > kXmlAddress) return Status::kInvalidAddress;
  for (std::uint32_t at = address; at < end; at += 4) {
    if (const Status status = checkRead(at); status != Status::kSuccess) return status;
  }
  std::memcpy(out.data(), &bytes_[address], out.size());
  return Status::kSuccess;
}

std::span<const std::uint8_t> Registers::discoveryAnswer() const {
  return std::span(bytes_).first(kDiscoveryBytes);
}

}  // namespace emulator
