#pragma once

namespace emulator::studio {

/// The hall in the rig frame: floor at z = 0, the athlete works around the origin and the cameras
/// stand on the side of -y. Metres.
inline constexpr float kHallLeft_m = -10.5f;
inline constexpr float kHallRight_m = 10.5f;
inline constexpr float kHallFront_m = -8.5f;
inline constexpr float kHallBack_m = 7.5f;
inline constexpr float kHallHeight_m = 6.6f;
inline constexpr float kLampHeight_m = 6.1f;

}  // namespace emulator::studio
