// The decoders of trackers' messages, fed with anything: whatever they give is sound, and nothing of what is not.
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "bridges/trackers/decoding.hpp"

namespace {

using namespace tandem::bridges;

void expect(bool condition) {
  if (!condition) std::abort();
}

void check(bool good, const std::vector<Sighting>& seen) {
  expect(good || seen.empty());
  expect(seen.size() <= trackers::kMostPoses);
  for (const Sighting& sighting : seen) {
    expect(trackers::is_sound(sighting));
    expect(!sighting.who().empty() && sighting.who().size() <= Sighting::kLongestName);
  }
}

void put(std::vector<std::uint8_t>& bytes, std::uint64_t value, int size) {
  for (int i = size; i-- > 0;) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto decode = [](const std::uint8_t* bytes, std::size_t count) {
    const std::span all(reinterpret_cast<const std::byte*>(bytes), count);
    std::vector<Sighting> seen;
    check(trackers::decode_json(all, seen), seen);
    seen.clear();
    check(trackers::decode_compact(all, seen), seen);
    seen.clear();
    check(trackers::decode_lcm(all, seen), seen);
  };
  decode(data, size);
  // Behind a good beginning, so that what follows is looked at, too.
  std::vector<std::uint8_t> compact = {'T', 'D', 'P', '1', static_cast<std::uint8_t>(size / 40), 0, 0, 0};
  put(compact, 1, 8);
  compact.insert(compact.end(), data, data + size / 40 * 40);
  decode(compact.data(), compact.size());
  std::vector<std::uint8_t> lcm;
  put(lcm, 0x3B0C721C5A9738D7, 8);
  lcm.insert(lcm.end(), data, data + size);
  decode(lcm.data(), lcm.size());
  std::vector<std::uint8_t> json = {'{', '"', 'i', 'd', '"', ':', '"', 'a', '"', ','};
  json.insert(json.end(), data, data + size);
  json.push_back('}');
  decode(json.data(), json.size());
  return 0;
}
