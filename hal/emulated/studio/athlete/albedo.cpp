#include "hal/emulated/studio/athlete/albedo.h"

namespace emulator::studio {

const char* athleteAlbedoSource() {
  return R"glsl(
uniform vec3 athlete_skin;
uniform vec3 athlete_hair;
uniform vec3 athlete_eye;
uniform vec3 athlete_shirt;
uniform vec3 athlete_trim;
uniform vec3 athlete_shorts;
uniform vec3 athlete_shoe;
uniform vec4 athlete_look;

float athleteHash(vec3 p) {
  p = fract(p * vec3(0.1031, 0.1030, 0.0973));
  p += dot(p, p.yxz + 33.33);
  return fract((p.x + p.y) * p.z);
}

float athleteNoise(vec3 p) {
  vec3 i = floor(p);
  vec3 f = p - i;
  f = f * f * (3.0 - 2.0 * f);
  float a = mix(athleteHash(i), athleteHash(i + vec3(1, 0, 0)), f.x);
  float b = mix(athleteHash(i + vec3(0, 1, 0)), athleteHash(i + vec3(1, 1, 0)), f.x);
  float c = mix(athleteHash(i + vec3(0, 0, 1)), athleteHash(i + vec3(1, 0, 1)), f.x);
  float d = mix(athleteHash(i + vec3(0, 1, 1)), athleteHash(i + vec3(1, 1, 1)), f.x);
  return mix(mix(a, b, f.y), mix(c, d, f.y), f.z);
}

// 1 inside an ellipse, soft over its last part.
float athleteSpot(vec2 p, vec2 centre, vec2 radii, float soft) {
  return 1.0 - smoothstep(1.0 - soft, 1.0 + soft, length((p - centre) / radii));
}

// Seven strokes of a digit in a field of 1 x 1.7, centre 0: distance to the nearest lit one.
float athleteStroke(vec2 p, vec2 a, vec2 b) {
  vec2 ab = b - a;
  return length(p - a - ab * clamp(dot(p - a, ab) / dot(ab, ab), 0.0, 1.0));
}
float athleteDigit(int digit, vec2 p) {
  const int lit[10] = int[10](119, 36, 93, 109, 46, 107, 123, 37, 127, 111);
  int mask = lit[digit];
  float d = 9.0;
  if ((mask & 1) != 0) d = min(d, athleteStroke(p, vec2(-0.4, 0.8), vec2(0.4, 0.8)));
  if ((mask & 2) != 0) d = min(d, athleteStroke(p, vec2(-0.4, 0.8), vec2(-0.4, 0.0)));
  if ((mask & 4) != 0) d = min(d, athleteStroke(p, vec2(0.4, 0.8), vec2(0.4, 0.0)));
  if ((mask & 8) != 0) d = min(d, athleteStroke(p, vec2(-0.4, 0.0), vec2(0.4, 0.0)));
  if ((mask & 16) != 0) d = min(d, athleteStroke(p, vec2(-0.4, 0.0), vec2(-0.4, -0.8)));
  if ((mask & 32) != 0) d = min(d, athleteStroke(p, vec2(0.4, 0.0), vec2(0.4, -0.8)));
  if ((mask & 64) != 0) d = min(d, athleteStroke(p, vec2(-0.4, -0.8), vec2(0.4, -0.8)));
  return d;
}
float athleteNumber(vec2 p, float size) {
  p /= size;
  int number = int(athlete_look.x + 0.5);
  float d = number < 10 ? athleteDigit(number, p)
                        : min(athleteDigit(number / 10, p + vec2(0.65, 0)),
                              athleteDigit(number % 10, p - vec2(0.65, 0)));
  return 1.0 - smoothstep(0.17, 0.21, d);
}

vec3 athleteSkinColour(vec3 p) {
  float seed = athlete_look.y;
  float female = athlete_look.z;
  float tone = athleteNoise(p * 14.0 + seed) * 0.6 + athleteNoise(p * 45.0 + seed) * 0.4;
  float pores = athleteNoise(p * 420.0);
  vec3 skin = athlete_skin * (0.92 + 0.16 * tone) * (0.96 + 0.08 * pores);
  skin = mix(skin, skin * vec3(1.10, 0.86, 0.82), 0.35 * athleteNoise(p * 28.0 + 7.0));
  float moles = athleteNoise(p * 95.0 + seed * 3.0);
  skin *= 1.0 - 0.30 * smoothstep(0.955, 0.99, moles);
  // Knees, elbows, knuckles and finger tips are redder.
  float knee = (1.0 - smoothstep(0.01, 0.06, abs(p.z - 0.505))) * smoothstep(-0.01, 0.05, p.y);
  skin = mix(skin, skin * vec3(1.05, 0.82, 0.78), 0.6 * knee);
  float hand = smoothstep(0.70, 0.80, abs(p.x));
  skin = mix(skin, skin * vec3(1.08, 0.84, 0.80), 0.6 * hand);
  if (p.z < 1.53 || abs(p.x) > 0.12) return skin;

  vec2 face = vec2(abs(p.x), p.z);
  float front = smoothstep(0.02, 0.06, p.y);
  // Cheeks, nose and ears are redder, sockets darker.
  float red = 0.8 * athleteSpot(face, vec2(0.042, 1.648), vec2(0.024, 0.022), 0.7) +
              0.8 * athleteSpot(face, vec2(0.0, 1.645), vec2(0.018, 0.014), 0.7);
  red = max(red * front, smoothstep(0.074, 0.082, face.x) * step(1.62, p.z));
  skin = mix(skin, skin * vec3(1.10, 0.74, 0.70), 0.6 * red);
  float socket = athleteSpot(face, vec2(0.032, 1.684), vec2(0.022, 0.013), 0.7) * front;
  skin = mix(skin, skin * vec3(0.74, 0.64, 0.64), 0.55 * socket);
  // Beard shadow.
  float jaw = smoothstep(1.645, 1.625, p.z - 0.25 * max(abs(p.x) - 0.03, 0.0)) *
              smoothstep(1.55, 1.575, p.z) * smoothstep(0.0, 0.03, p.y);
  skin = mix(skin, mix(skin, athlete_hair, 0.5), 0.32 * jaw * (1.0 - female) *
             (0.6 + 0.8 * athleteNoise(p * 700.0)));
  // Lips.
  float bow = 1.6245 - 0.0016 * smoothstep(0.006, 0.0, face.x) - 10.0 * face.x * face.x;
  float under = 1.6070 + 13.0 * face.x * face.x;
  float lips = smoothstep(bow + 0.001, bow - 0.001, p.z) *
               smoothstep(under - 0.001, under + 0.001, p.z) * step(0.07, p.y) *
               smoothstep(0.0265, 0.0235, face.x);
  vec3 lip = athlete_skin * mix(vec3(0.86, 0.50, 0.50), vec3(0.85, 0.36, 0.38), female);
  lip *= 0.9 + 0.2 * athleteNoise(vec3(p.x * 900.0, p.z * 80.0, 0.0));
  skin = mix(skin, lip, 0.85 * lips);
  float line = 1.0 - smoothstep(0.0004, 0.0014, abs(p.z - 1.6167));
  skin *= 1.0 - 0.65 * line * step(0.07, p.y) * smoothstep(0.0265, 0.0235, face.x);
  // Brows: hairs between two arcs.
  float along = (face.x - 0.012) / 0.042;
  float arc = 1.7005 + 0.0075 * sin(clamp(along, 0.0, 1.0) * 2.2) + 0.0015 * female;
  float thick = mix(0.0052, 0.0030, female) * (1.0 - 0.6 * along);
  float brow = smoothstep(thick, thick * 0.4, abs(p.z - arc)) * smoothstep(-0.05, 0.08, along) *
               smoothstep(1.05, 0.85, along) * step(0.03, p.y);
  brow *= 0.65 + 0.5 * athleteNoise(vec3(p.x * 700.0 + p.z * 500.0, p.z * 150.0, 3.0));
  skin = mix(skin, athlete_hair * 1.2 + 0.01, clamp(brow, 0.0, 0.92));
  // Lashes: a dark line along the lids.
  vec2 eye = face - vec2(0.0315, 1.6850);
  eye.y += 0.03 * eye.x;
  float rim = length(eye / vec2(0.0140, 0.0048));
  float lash = (1.0 - smoothstep(0.06, 0.22, abs(rim - 1.03))) * (eye.y > 0.0 ? 1.0 : 0.45);
  skin = mix(skin, athlete_hair * 0.5, (0.55 + 0.3 * female) * lash * step(0.07, p.y));
  // The scalp under the hair.
  float scalp = smoothstep(1.745, 1.765, p.z + 0.4 * max(-p.y, 0.0));
  return mix(skin, mix(skin, athlete_hair, 0.6), scalp);
}

vec3 athleteEyeColour(vec3 p) {
  vec2 eye = vec2(abs(p.x) - 0.0310, p.z - 1.6853);
  float r = length(eye);
  float rays = athleteNoise(vec3(normalize(eye + 1e-5) * 9.0, 1.0));
  vec3 white = vec3(0.62, 0.57, 0.54) * (1.0 - 0.25 * smoothstep(0.006, 0.012, r));
  vec3 iris = athlete_eye * (0.6 + 0.9 * rays) * mix(1.3, 0.5, smoothstep(0.003, 0.0056, r));
  vec3 colour = mix(iris, white, smoothstep(0.0051, 0.0058, r));
  colour *= smoothstep(0.0020, 0.0026, r) * 0.97 + 0.03;
  float glint = 1.0 - smoothstep(0.0006, 0.0012, length(eye - vec2(0.0018, 0.0022)));
  return mix(colour, vec3(0.9), glint) * (0.55 + 0.45 * smoothstep(0.0055, 0.0, eye.y));
}

vec3 athleteHairColour(vec3 p) {
  float azimuth = atan(p.x, -p.y + 0.03);
  float fine = athleteNoise(vec3(azimuth * 95.0, p.z * 30.0, p.y * 30.0));
  float locks = athleteNoise(vec3(azimuth * 22.0, p.z * 12.0, p.y * 14.0));
  return athlete_hair * (0.45 + 0.75 * fine + 0.5 * locks);
}

// Where the sleeve's hem begins, along the arm.
float athleteSleeve(vec3 p) {
  return dot(vec3(abs(p.x), p.y, p.z) - vec3(0.18, -0.015, 1.452), vec3(0.9131, 0.0, -0.4078)) -
         3.0 * max(1.22 - p.z, 0.0);
}

vec3 athleteShirtColour(vec3 p) {
  float weave = 0.96 + 0.04 * sin(p.x * 2600.0) * sin(p.z * 2600.0);
  weave *= 0.93 + 0.14 * athleteNoise(p * vec3(70.0, 70.0, 35.0));
  float seam = smoothstep(0.0014, 0.0006, abs(p.z - 0.860)) +
               smoothstep(0.0014, 0.0006, abs(athleteSleeve(p) - 0.005));
  return athlete_shirt * weave * (1.0 - 0.35 * clamp(seam, 0.0, 1.0));
}

// Panels at the flanks, a band across the chest, cuffs, collar, number, name and a crest.
vec4 athleteShirtPrint(vec3 p) {
  float side = abs(p.x);
  float flank = smoothstep(0.026, 0.022, abs(p.y + 0.01)) * step(p.z, 1.36) * step(0.1, side);
  float collar = (p.z - 1.505) * 0.93 + (p.y + 0.055) * 0.36 - 6.0 * side * side;
  float trim = max(max(smoothstep(-0.018, -0.016, collar) * step(side, 0.13),
                       smoothstep(0.186, 0.188, athleteSleeve(p))),
                   flank);
  bool back = p.y < -0.02;
  vec2 at = vec2(back ? p.x : -p.x, p.z);
  float band = back ? 0.0
                    : smoothstep(0.029, 0.027, abs(p.z - 1.255)) * step(side, 0.19) *
                          (0.75 + 0.25 * step(0.3, fract(p.x * 9.0)));
  float number = back ? athleteNumber(at - vec2(0.0, 1.245), 0.085)
                      : athleteNumber(at - vec2(-0.075, 1.375), 0.026);
  float name = 0.0;
  if (back && abs(p.z - 1.395) < 0.017 && side < 0.105) {
    name = step(0.45, athleteHash(floor(vec3(at.x * 95.0, p.z * 130.0, athlete_look.y))));
    name *= step(0.22, fract(at.x * 24.0));
  }
  float crest = back ? 0.0 : athleteSpot(at, vec2(0.078, 1.375), vec2(0.018, 0.022), 0.06);
  vec4 print = vec4(athlete_trim * 0.96,
                    clamp(max(max(trim, band * 0.9), max(number, name)), 0.0, 1.0));
  vec3 stripes = mix(athlete_trim, athlete_shorts, step(0.5, fract(at.x * 70.0)));
  return mix(print, vec4(stripes, 1.0), crest);
}

vec3 athleteShortsColour(vec3 p) {
  float weave = 0.9 + 0.2 * athleteNoise(p * vec3(60.0, 60.0, 30.0));
  float hem = smoothstep(0.0012, 0.0005, abs(p.z - 0.622));
  return athlete_shorts * weave * (1.0 - 0.4 * hem);
}

vec4 athleteShortsPrint(vec3 p) {
  float stripe = 0.0;
  for (int i = -1; i <= 1; ++i) {
    stripe = max(stripe, smoothstep(0.0055, 0.0045, abs(p.y - 0.015 * float(i))));
  }
  stripe *= step(0.13, abs(p.x));
  float badge = athleteSpot(vec2(p.x, p.z), vec2(0.105, 0.665), vec2(0.02, 0.014), 0.06) *
                step(0.03, p.y);
  return vec4(athlete_trim, max(stripe, badge));
}

vec3 athleteShoeColour(vec3 p) {
  return athlete_shoe * (0.92 + 0.16 * athleteNoise(p * 260.0));
}

// Toe cap, heel counter, three slanted bars on the flanks, tongue and laces.
vec4 athleteShoePrint(vec3 p) {
  float x = abs(abs(p.x) - 0.115);
  vec4 print = vec4(athlete_shoe * 0.45, smoothstep(0.120, 0.124, p.y) * step(p.z, 0.055));
  print = mix(print, vec4(athlete_trim * 0.9, 1.0), smoothstep(-0.048, -0.052, p.y) * step(p.z, 0.075));
  float bars = step(0.5, fract((p.y - p.z * 0.5) * 36.0)) * step(0.0, p.y) * step(p.y, 0.075) *
               step(0.026, x) * step(p.z, 0.070) * step(0.022, p.z);
  print = mix(print, vec4(athlete_trim, 1.0), bars);
  float tongue = step(x, 0.017) * step(0.03, p.y) * step(p.y, 0.115) * step(0.055, p.z);
  print = mix(print, vec4(athlete_shoe * 0.35, 1.0), tongue);
  float lace = step(0.45, fract(p.y * 75.0 + 0.35 * x / 0.017)) * step(x, 0.021) *
               step(0.032, p.y) * step(p.y, 0.112) * step(0.055, p.z);
  return mix(print, vec4(vec3(0.78), 1.0), lace);
}

vec3 athleteBallColour(vec3 p) {
  // Panels of twelve patches around an icosahedron's corners.
  vec3 n = normalize(p);
  const float a = 0.5257311, b = 0.8506508;
  vec3 q = abs(n);
  float corner = max(max(a * q.x + b * q.z, a * q.z + b * q.y), a * q.y + b * q.x);
  float patch_ = smoothstep(0.925, 0.93, corner);
  float seam = 1.0 - smoothstep(0.002, 0.007, abs(corner - 0.927));
  vec3 colour = mix(vec3(0.80, 0.55, 0.06), vec3(0.03, 0.07, 0.30), patch_);
  colour *= (1.0 - 0.6 * seam) * (0.9 + 0.2 * athleteNoise(n * 60.0));
  return colour * (0.85 + 0.3 * athleteNoise(n * 3.0));
}

vec3 athleteGround(int material, vec2 uv, vec3 rest_position) {
  vec3 p = rest_position;
  if (material == 0) return athleteSkinColour(p);
  if (material == 1) return athleteEyeColour(p);
  if (material == 2) return athleteHairColour(p);
  if (material == 3) return athleteShirtColour(p);
  if (material == 4) return athleteShortsColour(p);
  if (material == 5) {
    float rib = 0.92 + 0.08 * sin(uv.x * 900.0);
    float ring = step(0.178, p.z) * step(p.z, 0.188);
    return mix(vec3(0.72), athlete_shirt, ring) * rib;
  }
  if (material == 6) return athleteShoeColour(p);
  if (material == 7) {
    float dirt = athleteNoise(p * 90.0);
    return mix(vec3(0.74, 0.73, 0.70), vec3(0.30, 0.28, 0.25), 0.35 * dirt);
  }
  return athleteBallColour(p);
}

vec4 athletePrint(int material, vec3 rest_position) {
  if (material == 3) return athleteShirtPrint(rest_position);
  if (material == 4) return athleteShortsPrint(rest_position);
  if (material == 6) return athleteShoePrint(rest_position);
  return vec4(0.0);
}

vec3 athleteAlbedo(int material, vec2 uv, vec3 rest_position) {
  vec4 print = athletePrint(material, rest_position);
  return mix(athleteGround(material, uv, rest_position), print.rgb, print.a);
}

float athleteGloss(int material, vec3 rest_position) {
  if (material == 0) return 0.22 + 0.12 * athleteNoise(rest_position * 40.0);
  if (material == 1) return 0.9;
  if (material == 2) return 0.3;
  if (material == 6) return 0.25;
  if (material == 8) return 0.3;
  return 0.06;
}

vec3 athleteBump(int material, vec3 rest_position) {
  float scale = material == 2 ? 160.0 : 320.0;
  float depth = material == 2 ? 0.30 : material == 0 ? 0.05 : material >= 3 && material <= 5 ? 0.08 : 0.0;
  if (depth == 0.0) return vec3(0.0);
  vec3 p = rest_position * scale;
  return depth * (vec3(athleteNoise(p), athleteNoise(p + 17.0), athleteNoise(p + 31.0)) - 0.5);
}
)glsl";
}

std::array<AlbedoUniform, 8> albedoUniforms(const BodyShape& shape) {
  const auto colour = [](const char* name, const Eigen::Vector3f& c) {
    return AlbedoUniform{name, 3, {c.x(), c.y(), c.z(), 0}};
  };
  return {{colour("athlete_skin", shape.skin),
           colour("athlete_hair", shape.hair),
           colour("athlete_eye", shape.eye),
           colour("athlete_shirt", shape.shirt),
           colour("athlete_trim", shape.shirt_trim),
           colour("athlete_shorts", shape.shorts),
           colour("athlete_shoe", shape.shoe),
           {"athlete_look",
            4,
            {static_cast<float>(shape.number % 100), static_cast<float>(shape.seed % 64),
             shape.sex == Sex::kFemale ? 1.0F : 0.0F, 0}}}};
}

}  // namespace emulator::studio
