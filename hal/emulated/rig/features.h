#pragma once

#include <cstdint>
#include <span>
#include <string_view>

/// The one table of the emulated camera's settings: it makes the GenICam file that
/// clients read and the checks that the registers do, so the two cannot disagree. Names
/// and behaviour follow GenICam SFNC, as a Basler ace shows them.
namespace emulator {

struct EnumEntry {
  std::string_view name;
  std::uint32_t value;
};

enum class FeatureKind : std::uint8_t { kInteger, kFloat, kBoolean, kEnumeration, kCommand };

struct Feature {
  std::string_view name;
  std::uint32_t address;
  FeatureKind kind;
  double power_on = 0;
  double min = 0;
  double max = 0;
  std::uint32_t increment = 1;
  std::span<const EnumEntry> entries{};
  std::string_view unit{};
  bool writable = true;
  bool fixed_while_acquiring = false;
  std::uint32_t locked_by = 0;    ///< address of an "auto" feature; nonzero there refuses writes
  std::string_view max_from{};    ///< another feature that holds the largest value
  std::string_view index_from{};  ///< selector: the address grows by 4 per its value
};

/// Addresses of the vendor registers, and of the bootstrap registers that have effects.
namespace reg {
inline constexpr std::uint32_t kUserName = 0x00e8;
inline constexpr std::uint32_t kHeartbeatTimeout = 0x0938;
inline constexpr std::uint32_t kLinkSpeed = 0x0670;
inline constexpr std::uint32_t kTimestampTickHigh = 0x093c;
inline constexpr std::uint32_t kTimestampControl = 0x0944;
inline constexpr std::uint32_t kTimestampValueHigh = 0x0948;
inline constexpr std::uint32_t kTimestampValueLow = 0x094c;
inline constexpr std::uint32_t kControlPrivilege = 0x0a00;
inline constexpr std::uint32_t kControllerPort = 0x0a04;  // "primary application" in the standard
inline constexpr std::uint32_t kControllerAddress = 0x0a14;
inline constexpr std::uint32_t kStreamPort = 0x0d00;
inline constexpr std::uint32_t kStreamPacketSize = 0x0d04;
inline constexpr std::uint32_t kStreamPacketDelay = 0x0d08;
inline constexpr std::uint32_t kStreamDestination = 0x0d18;

inline constexpr std::uint32_t kSensorWidth = 0x8000;
inline constexpr std::uint32_t kSensorHeight = 0x8004;
inline constexpr std::uint32_t kWidth = 0x8008;
inline constexpr std::uint32_t kHeight = 0x800c;
inline constexpr std::uint32_t kOffsetX = 0x8010;
inline constexpr std::uint32_t kOffsetY = 0x8014;
inline constexpr std::uint32_t kPixelFormat = 0x8018;
inline constexpr std::uint32_t kAcquisitionMode = 0x8020;
inline constexpr std::uint32_t kAcquisitionStart = 0x8024;
inline constexpr std::uint32_t kAcquisitionStop = 0x8028;
inline constexpr std::uint32_t kFrameRateEnable = 0x802c;
inline constexpr std::uint32_t kFrameRate = 0x8030;
inline constexpr std::uint32_t kTriggerSelector = 0x8040;
inline constexpr std::uint32_t kTriggerMode = 0x8044;
inline constexpr std::uint32_t kTriggerSource = 0x8048;
inline constexpr std::uint32_t kTriggerActivation = 0x804c;
inline constexpr std::uint32_t kTriggerSoftware = 0x8050;
inline constexpr std::uint32_t kTriggerDelay = 0x8054;
inline constexpr std::uint32_t kExposureMode = 0x8060;
inline constexpr std::uint32_t kExposureTime = 0x8064;
inline constexpr std::uint32_t kExposureAuto = 0x8068;
inline constexpr std::uint32_t kGain = 0x806c;
inline constexpr std::uint32_t kGainAuto = 0x8070;
inline constexpr std::uint32_t kBalanceSelector = 0x8074;
inline constexpr std::uint32_t kBalanceAuto = 0x8078;
inline constexpr std::uint32_t kBalanceRatio = 0x8080;  // red, green, blue
inline constexpr std::uint32_t kPtpEnable = 0x80a0;
inline constexpr std::uint32_t kPtpStatus = 0x80a4;
inline constexpr std::uint32_t kPtpLatch = 0x80a8;
inline constexpr std::uint32_t kPtpOffset = 0x80ac;
inline constexpr std::uint32_t kActionDeviceKey = 0x80b0;
inline constexpr std::uint32_t kActionGroupKey = 0x80b4;
inline constexpr std::uint32_t kActionGroupMask = 0x80b8;
inline constexpr std::uint32_t kTemperature = 0x80c0;
inline constexpr std::uint32_t kDeviceReset = 0x80c4;
}  // namespace reg

enum class AcquisitionMode : std::uint32_t { kContinuous = 0, kSingleFrame = 1 };
enum class TriggerSource : std::uint32_t { kLine1 = 1, kSoftware = 2, kAction1 = 3 };
enum class TriggerActivation : std::uint32_t { kRisingEdge = 0, kFallingEdge = 1 };

inline constexpr std::uint32_t kMinPacketBytes = 576;

[[nodiscard]] std::span<const Feature> features();

}  // namespace emulator
