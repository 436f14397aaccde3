#include "appliance/director/programme.h"

namespace appliance {

bool Programme::add(const Cue& cue) RT_SAFE {
  if (count_ == cues_.size()) return false;
  cues_[count_++] = cue;
  return true;
}

void Programme::start(double angle_deg) RT_SAFE {
  next_ = 0;
  resting_ = false;
  walks_ = false;
  rate_ = Rate::kFull;
  move_ = Move{.from_deg = angle_deg, .to_deg = angle_deg};
}

Programme::Step Programme::step(rt::Timestamp t, std::uint64_t trigger) RT_SAFE {
  rt::Timestamp free_at = t;  // what begins in this step begins here
  for (;;) {
    if (resting_) {
      if (t < move_.end()) break;
      resting_ = false;
      free_at = move_.end();
    }
    if (next_ == count_ || trigger < cues_[next_].trigger) break;
    begin(cues_[next_++], free_at);
  }
  return {.rate = resting_ ? Rate::kStill : rate_,
          .angle_deg = walks_ ? std::optional(move_.angle(t)) : std::nullopt,
          .ended = next_ == count_ && !resting_ && t >= move_.end()};
}

void Programme::begin(const Cue& cue, rt::Timestamp at) RT_SAFE {
  const double from_deg = move_.angle(at);
  rate_ = cue.rate;
  resting_ = cue.hold.has_value();
  walks_ = walks_ || cue.angle_deg.has_value();
  if (!cue.angle_deg && !resting_) return;  // the view goes on with what it does
  move_ = Move{.from_deg = from_deg,
               .to_deg = cue.angle_deg.value_or(from_deg),
               .speed_deg_per_s = cue.speed_deg_per_s,
               .ease = cue.ease,
               .pause = cue.hold.value_or(rt::Nanoseconds::zero()),
               .begin = at};
}

}  // namespace appliance
