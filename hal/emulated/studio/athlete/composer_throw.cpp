#include <algorithm>
#include <cmath>

#include "hal/emulated/studio/athlete/composer.h"

namespace emulator::studio {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

ArmPosture heldAs(ArmPosture arm, double pronation, double wrist, double grip) {
  arm.pronation = pronation;
  arm.wrist = wrist;
  arm.grip = grip;
  return arm;
}

}  // namespace

/// Writes one throw in the axes of a right-hander: x away from the free arm, angles towards the
/// free side. A left-hander's throw is the mirror image.
class ThrowWriter {
 public:
  ThrowWriter(Composer& composer, double tempo)
      : c_(composer),
        start_(composer.now_),
        tempo_(tempo),
        mirror_(composer.left_handed_ ? -1.0 : 1.0),
        throwing_(composer.left_handed_ ? Side::kLeft : Side::kRight),
        free_(composer.left_handed_ ? Side::kRight : Side::kLeft),
        place_(composer.place_),
        heading_(composer.heading_) {}

  [[nodiscard]] double at(double t) const { return start_ + t * tempo_; }

  struct Trunk {
    double x, y, z;     // pelvis
    double turn;        // pelvis against the throw's direction
    double twist;       // shoulders against the pelvis
    double bend, side;  // positive side: away from the throwing arm
  };
  void trunk(double t, const Trunk& k) {
    Score& s = c_.score_;
    s.pelvis(at(t), c_.beside(place_, heading_, mirror_ * k.x, k.y), k.z);
    s.heading.key(at(t), heading_ + mirror_ * k.turn);
    s.pelvis_bend.key(at(t), 0.35 * k.bend);
    s.trunk(at(t), {0.65 * k.bend, -mirror_ * k.side, mirror_ * k.twist});
    // The eyes stay on the target.
    s.head_turn.key(at(t), -mirror_ * std::clamp(0.85 * (k.turn + k.twist), -1.05, 1.05));
    s.head_bend.key(at(t), -0.55 * k.bend);
  }
  void throwing(double t, const ArmPosture& arm) { c_.arm(throwing_).key(at(t), arm); }
  void free(double t, const ArmPosture& arm) { c_.arm(free_).key(at(t), arm); }
  void step(Side side, double off, double on, double x, double y, double yaw, double height_m) {
    c_.step(side, at(off), at(on), c_.beside(place_, heading_, mirror_ * x, y),
            heading_ + mirror_ * yaw, height_m);
  }
  void pitch(Side side, double t, double angle) { c_.foot(side).pitch.key(at(t), angle); }
  [[nodiscard]] Side throwingSide() const { return throwing_; }
  [[nodiscard]] Side freeSide() const { return free_; }

 private:
  Composer& c_;
  double start_;
  double tempo_;
  double mirror_;
  Side throwing_;
  Side free_;
  Vector2d place_;
  double heading_;
};

void Composer::throwBall(Action kind) {
  shift(place_, throw_heading_);
  takeBall();
  const double speed = 1 + random_.uniform(-0.15F, 0.15F);
  const double height = random_.uniform(-0.8F, 0.9F);
  const double reach = random_.uniform(0.92F, 1.08F);  // of the stride
  const bool slow = kind == Action::kSlowThrow;
  const bool aborted = kind == Action::kAbortedThrow;
  const double tempo = (slow ? 3.0 : 1.0) / speed;
  begin(kind, Phase::kWindUp);
  rest(now_);

  // Seconds of a throw at the usual speed.
  const double wind_up = 0.62 + random_.uniform(-0.08F, 0.10F);
  const double stride = wind_up + 0.02;
  const double contact = wind_up + 0.42;
  const double cocked = contact + 0.12;
  const double in_front = cocked + 0.100;  // the hand is before the head
  const double release = cocked + 0.055;   // and is fastest a little earlier: there the ball leaves
  const double turned_in = in_front + 0.075;
  const double through = in_front + 0.32;
  const double step_through = in_front + 0.50;
  const double upright = in_front + 1.05;
  const double stride_m = 0.80 * reach;

  ThrowWriter w(*this, tempo);
  const Side back = w.throwingSide();
  const Side front = w.freeSide();
  // Ball up and back, pelvis turned away, weight on the rear leg.
  w.step(back, 0.10, 0.42, 0.12, -0.10, -1.15, 0.05);
  w.trunk(wind_up, {0.055, -0.075, 0.945, -1.10, -0.30, -0.04, -0.05});
  w.throwing(wind_up,
             heldAs(armTowards({0.80, -0.40, -0.30}, {0.75, -0.35, 0.45}), 0.9, -0.1, 0.25));
  w.free(wind_up, heldAs(armTowards({0.85, 0.50, 0.02}, {0.70, 0.70, 0.12}), 0.5, 0.1, 0.25));

  w.step(front, stride, contact, -0.06, stride_m, -0.22, 0.17);
  w.pitch(front, stride - 0.12, 0);
  w.pitch(front, stride + 0.03, 0.45);
  w.pitch(front, stride + 0.24, 0.05);
  w.pitch(front, contact - 0.01, -0.22);
  w.pitch(front, contact + 0.09, 0);
  w.trunk(contact, {0.00, 0.40 * stride_m, 0.885, -0.80, -0.50, -0.10, -0.02});
  const double raise = 0.22 * height;
  w.throwing(contact, heldAs(armTowards({0.92, -0.36, 0.02 + raise}, {0.28, -0.20, 0.95}), 0.7,
                             -0.35, 0.25));
  w.free(contact, heldAs(armTowards({0.93, 0.32, 0.04}, {0.80, 0.60, 0.05}), 0.5, 0.0, 0.2));
  const double lean = 0.26 + 0.20 * height;

  if (aborted) {
    // He stays over the front foot, lets the arm sink and steps back.
    const double stop = contact + 0.16;
    const double down = contact + 0.75;
    w.trunk(stop, {-0.01, 0.50 * stride_m, 0.880, -0.55, -0.25, 0.02, 0.05});
    w.throwing(stop, heldAs(armTowards({0.90, -0.15, 0.05}, {0.35, 0.10, 0.93}), 0.6, -0.2, 0.25));
    w.free(stop, heldAs(armTowards({0.80, 0.45, -0.40}, {0.50, 0.85, 0.10}), 0.5, 0, 0.25));
    w.trunk(down, {0.02, 0.30 * stride_m, 0.930, -0.45, -0.05, 0.05, 0});
    w.step(front, down - 0.25, down + 0.20, -0.105, 0.02, 0.12, 0.06);
    w.step(back, down + 0.25, down + 0.60, 0.105, 0.02, -0.12, 0.05);
    throws_.push_back({kind, left_handed_, now_, w.at(stride), w.at(contact), w.at(stop),
                       w.at(stop), w.at(stop), w.at(down + 0.75), speed, height});
    phase(w.at(stride), Phase::kStride);
    phase(w.at(contact), Phase::kArmCocking);
    phase(w.at(stop), Phase::kRecovery);
    place_ = beside(place_, heading_, 0, 0.02);
    rest(w.at(down + 0.75));
    end(w.at(down + 0.75));
    return;
  }

  // Pelvis first, shoulders after, the forearm stays behind.
  w.trunk(cocked, {-0.02, 0.54 * stride_m, 0.880, -0.20, -0.12, -0.16, 0.55 * lean});
  w.throwing(cocked, heldAs(armTowards({0.95, -0.02, 0.16 + raise}, {0.20, -0.86, 0.46}), 0.7,
                            -0.55, 0.25));
  w.free(cocked, heldAs(armTowards({0.75, 0.25, -0.60}, {0.20, 0.90, 0.35}), 0.3, 0, 0.4));
  w.trunk(in_front, {-0.03, 0.60 * stride_m, 0.890, 0.10, 0.18, 0.22, lean});
  w.throwing(in_front,
             heldAs(armTowards({0.80, 0.48, 0.40 + raise}, {0.42, 0.58, 0.72}), 0.5, 0.25, 0.20));
  w.free(in_front, heldAs(armTowards({0.55, -0.10, -0.82}, {0.12, 0.85, 0.50}), 0.2, 0, 0.6));
  w.trunk(turned_in, {-0.03, 0.65 * stride_m, 0.890, 0.22, 0.32, 0.38, lean});
  w.throwing(turned_in,
             heldAs(armTowards({0.62, 0.76, 0.12}, {0.26, 0.93, -0.10}), 0.9, 0.45, 0.2));
  w.trunk(through, {-0.02, 0.80 * stride_m, 0.895, 0.40, 0.42, 0.62, 0.5 * lean});
  w.throwing(through,
             heldAs(armTowards({-0.10, 0.72, -0.68}, {-0.62, 0.42, -0.66}), 0.9, 0.2, 0.3));
  w.free(through, heldAs(armTowards({0.45, -0.50, -0.72}, {0.20, 0.20, -0.95}), 0.2, 0, 0.5));

  // The rear foot comes off its heel, drags and steps through.
  w.pitch(back, contact - 0.02, 0);
  w.pitch(back, in_front + 0.02, 0.75);
  w.step(back, in_front + 0.06, step_through, 0.13, stride_m + 0.10, -0.10, 0.14);
  w.pitch(back, in_front + 0.26, 0.50);
  w.pitch(back, step_through - 0.01, -0.08);
  w.pitch(back, step_through + 0.10, 0);
  w.trunk(step_through + 0.06, {0.03, 1.0 * stride_m, 0.925, 0.18, 0.15, 0.32, 0.05});
  w.step(front, step_through + 0.10, step_through + 0.42, -0.09, stride_m + 0.08, 0.10, 0.05);

  if (!slow) {
    ball_.push_back({BallEvent::Kind::kRelease, w.at(release), w.throwingSide()});
    holds_ball_ = false;
  }
  throws_.push_back({kind, left_handed_, now_, w.at(stride), w.at(contact), w.at(cocked),
                     w.at(release), w.at(turned_in), w.at(upright), speed, height});
  phase(w.at(stride), Phase::kStride);
  phase(w.at(contact), Phase::kArmCocking);
  phase(w.at(cocked), Phase::kArmAcceleration);
  phase(w.at(release), Phase::kArmDeceleration);
  phase(w.at(turned_in), Phase::kFollowThrough);
  phase(w.at(step_through), Phase::kRecovery);
  place_ = beside(place_, heading_, (left_handed_ ? -1.0 : 1.0) * 0.02, stride_m + 0.09);
  rest(w.at(upright));
  end(w.at(upright));
}

void Composer::catchBall() {
  if (holds_ball_) return;
  shift(place_, throw_heading_);
  begin(Action::kCatch, Phase::kCatch);
  rest(now_);
  const double ready = now_ + 0.75;
  const double caught = ready + 0.25;
  const double done = caught + 0.55;
  const double high = random_.uniform(-0.25F, 0.35F);
  ArmPosture open = armTowards({0.22, 0.80, -0.50 + high}, {-0.16, 0.92, 0.28 + high});
  open.pronation = -0.5;
  open.grip = 0.15;
  ArmPosture soft = armTowards({0.28, 0.48, -0.80 + 0.6 * high}, {-0.36, 0.88, 0.30 + 0.5 * high});
  soft.pronation = -0.3;
  soft.grip = 0.22;
  for (const Side side : kSides) {
    arm(side).key(ready, open);
    arm(side).key(caught, open);
    arm(side).key(caught + 0.18, soft);
  }
  score_.pelvis(ready, beside(place_, heading_, 0, 0.03), 0.925);
  score_.trunk(ready, {0.14, 0, 0});
  score_.pelvis(caught + 0.12, beside(place_, heading_, 0, -0.01), 0.915);
  score_.trunk(caught + 0.12, {0.10, 0, 0});
  score_.head_bend.key(ready, -0.06);
  ball_.push_back({BallEvent::Kind::kArrive, caught, left_handed_ ? Side::kLeft : Side::kRight});
  holds_ball_ = true;
  rest(done);
  end(done);
}

void Composer::stretch() {
  begin(Action::kStretch, Phase::kStretch);
  rest(now_);
  double t = now_;
  const auto bothArms = [&](double when, const Vector3d& upper, const Vector3d& fore) {
    for (const Side side : kSides) arm(side).key(when, armTowards(upper, fore));
  };
  // As between two throws: a few seconds, one side.
  const Side side = random_.unit() < 0.5 ? Side::kLeft : Side::kRight;
  if (random_.unit() < 0.5) {
    // Arms up, and lean over.
    const double lean = side == Side::kLeft ? 0.32 : -0.32;
    bothArms(t + 0.9, {0.93, 0.15, 0.30}, {0.85, 0.25, 0.50});
    t += 1.8;
    bothArms(t, {0.40, 0.10, 0.91}, {-0.15, 0.12, 0.98});
    score_.trunk(t, {-0.06, 0, 0});
    score_.pelvis(t, place_, 0.962);
    t += vary(1.3, 0.15);
    score_.trunk(t, {-0.03, lean, 0});
    score_.pelvis(t, beside(place_, heading_, -0.10 * lean, 0), 0.958);
    bothArms(t, {0.38, 0.10, 0.92}, {-0.15, 0.12, 0.98});
    t += 0.5;
    score_.trunk(t, {-0.03, lean * 1.05, 0});
    score_.pelvis(t, beside(place_, heading_, -0.10 * lean, 0), 0.958);
    bothArms(t, {0.38, 0.10, 0.92}, {-0.15, 0.12, 0.98});
    t += 1.2;
    score_.trunk(t, {0, 0, 0});
    bothArms(t, {0.93, 0.05, 0.20}, {0.90, 0.30, 0.20});
  } else {
    // One arm across the chest, drawn closer by the other.
    const Side other = side == Side::kRight ? Side::kLeft : Side::kRight;
    const double turn = side == Side::kRight ? 0.15 : -0.15;
    t += 1.1;
    arm(side).key(t, armTowards({-0.28, 0.95, 0.02}, {-0.50, 0.86, 0.02}));
    arm(other).key(t, armTowards({0.20, 0.78, -0.45}, {-0.60, 0.35, 0.62}));
    score_.trunk(t, {0.02, 0, turn});
    t += 1.2;
    arm(side).key(t, armTowards({-0.30, 0.95, 0.04}, {-0.52, 0.85, 0.03}));
    arm(other).key(t, armTowards({0.20, 0.78, -0.45}, {-0.60, 0.33, 0.64}));
    score_.trunk(t, {0.02, 0, 1.2 * turn});
    t += 0.8;
    bothArms(t, {0.35, 0.45, -0.80}, {0.15, 0.80, -0.40});
  }
  rest(t + 1.2);
  end(t + 1.2);
}

}  // namespace emulator::studio
