// Ground sensors against the pixels of a picture that is written here, and laid over the floor.
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "core/sim/world.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/temporary_folder.hpp"
#include "validate/compared.hpp"
#include "validate/sensor_tables.hpp"

namespace tandem::validate {
namespace {

// The picture, and the arena that it lies over. Its pixels are no squares, and none has the shade of its neighbour.
constexpr std::uint32_t kColumns = 97, kLines = 61;
constexpr double kEast_m = 6.0, kNorth_m = 4.0;

/// Of a pixel, counted from the left and from the top: neither black nor white, so that noise is not cut off.
std::uint8_t shade(std::uint32_t column, std::uint32_t line) {
  return static_cast<std::uint8_t>(40 + (column * 73 + line * 151 + column * line * 29) % 176);
}

void append(std::string& bytes, std::uint32_t number) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift & 255U);
}

/// A chunk of a PNG file, with its check sum.
std::string chunk(const std::string& name, const std::string& content) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char byte : name + content) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1U ^ (crc & 1U ? 0xEDB88320U : 0U);
  }
  std::string bytes;
  append(bytes, static_cast<std::uint32_t>(content.size()));
  bytes += name + content;
  append(bytes, ~crc);
  return bytes;
}

/// A grey picture as a PNG file, whose data is stored as it is.
std::string png() {
  std::string pixels;
  for (std::uint32_t line = 0; line < kLines; ++line) {
    pixels += '\0';
    for (std::uint32_t column = 0; column < kColumns; ++column) pixels += static_cast<char>(shade(column, line));
  }
  std::uint32_t a = 1, b = 0;  // Adler's sum
  for (const char byte : pixels) {
    a = (a + static_cast<unsigned char>(byte)) % 65521U;
    b = (b + a) % 65521U;
  }
  const auto size = static_cast<std::uint32_t>(pixels.size());
  std::string data = {'\x78', '\x01', '\x01'};
  for (const std::uint32_t word : {size, ~size}) {
    data += static_cast<char>(word & 255U);
    data += static_cast<char>(word >> 8U & 255U);
  }
  data += pixels;
  append(data, b << 16U | a);
  std::string head;
  append(head, kColumns);
  append(head, kLines);
  head += std::string("\x08\x00\x00\x00\x00", 5);
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", head) + chunk("IDAT", data) + chunk("IEND", "");
}

template <class Reading, class Part>
void compare(const core::Space& space, std::size_t i, std::vector<Shade>& all) {
  const core::RobotId robot = space.robot(i);
  const auto* const read = space.port<Reading>(robot);
  const auto* const part = space.kind(robot).part<Part>();
  if (read == nullptr || part == nullptr) return;
  const core::Pose pose = space.pose(robot);
  for (std::size_t k = 0; k < part->mounts.size(); ++k) {
    const hal::Mount& m = part->mounts[k];
    const double x = pose.x_m + pose.cos_h * m.x_m - pose.sin_h * m.y_m;
    const double y = pose.y_m + pose.sin_h * m.x_m + pose.cos_h * m.y_m;
    const double column = (x + 0.5 * kEast_m) / kEast_m * kColumns, line = (0.5 * kNorth_m - y) / kNorth_m * kLines;
    const auto near_edge = [](double at) { return std::abs(at - std::round(at)) < 1e-6; };
    all.push_back({static_cast<double>(read->reflectance[k]),
                   shade(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(line)) / 255.0,
                   near_edge(column) || near_edge(line)});
  }
}

}  // namespace

std::vector<Shade> shades(const std::string& implementation, std::uint64_t seed, int ticks) {
  const hal::TemporaryFolder folder("tandem_floor");
  std::ofstream(folder.file("floor.png"), std::ios::binary) << png();
  const auto opened =
      open_experiment("floor.xml", seed, {{"{ground}", implementation}, {"{picture}", folder.file("floor.png")}});
  core::World& world = opened->world();
  std::vector<Shade> all;
  for (int tick = 0; tick < ticks; ++tick) {
    world.step();
    for (std::size_t i = 0; i < world.space().robot_count(); ++i) {
      compare<hal::BaseGround, hal::BaseGroundPart>(world.space(), i, all);
      compare<hal::MotorGround, hal::MotorGroundPart>(world.space(), i, all);
      compare<hal::Ground, hal::GroundPart>(world.space(), i, all);
    }
  }
  return all;
}

Row floor_row(Depth depth) {
  Compared all;
  for (std::uint64_t seed = 1; seed <= (depth == Depth::Short ? 3U : 40U); ++seed)
    for (const Shade& s : shades("ideal", seed, 1)) {
      if (s.edge)
        ++all.edges;
      else
        all.add(std::abs(s.read - s.is), 1e-6);
    }
  return compared_row("ground sensors of foot-bots and e-pucks over a picture", all, 1.0, "of white",
                      "at most 0.000001");
}

}  // namespace tandem::validate
