// Nothing in the arena may share an id. A distributed item claims its prefix with every number from base_num on.
#include <charconv>
#include <map>
#include <optional>

#include "core/config/reading.hpp"

namespace tandem::core {
namespace {

/// The numbers [first, last] behind one prefix.
struct Numbers {
  std::int64_t first, last;
  int line;
};

class Claims {
 public:
  explicit Claims(Reading& reading) : reading_(reading) {}

  void add(const std::string& id, const std::optional<Distribute>& distribute, int line) {
    if (distribute ? distribute->quantity == 0 : id.empty()) return;
    if (distribute)
      distributed_[id].push_back({distribute->base_num, distribute->base_num + distribute->quantity - 1, line});
    else if (const auto [first, fresh] = single_.emplace(id, line); !fresh)
      clash(id, line, first->second);
  }

  void check() {
    for (const auto& one : single_) {
      for_each_split(one.first, [&](const std::string& prefix, std::int64_t number) {
        meet(prefix, {number, number, one.second}, one.first);
      });
    }
    for (auto& many : distributed_) {
      const std::string& prefix = many.first;
      std::vector<Numbers>& ranges = many.second;
      std::sort(ranges.begin(), ranges.end(), [](const Numbers& a, const Numbers& b) { return a.first < b.first; });
      for (std::size_t i = 1; i < ranges.size(); ++i) {
        if (ranges[i].first <= ranges[i - 1].last)
          clash(prefix + std::to_string(ranges[i].first), ranges[i].line, ranges[i - 1].line);
      }
      // "ep1" with the numbers 0 to 9 makes "ep10" to "ep19", as "ep" may.
      for_each_split(prefix, [&](const std::string& shorter, std::int64_t head) {
        for (const Numbers& numbers : ranges) meet_longer(shorter, head, numbers);
      });
    }
  }

 private:
  /// Calls `use` for every way to read the end of `id` as a number without leading zeros.
  template <class Use>
  static void for_each_split(const std::string& id, Use&& use) {
    for (std::size_t at = id.size(); at > 0 && id.size() - at < 18 && id[at - 1] >= '0' && id[at - 1] <= '9';) {
      --at;
      if (id[at] == '0' && id.size() - at > 1) continue;
      std::int64_t number = 0;
      std::from_chars(id.data() + at, id.data() + id.size(), number);
      use(id.substr(0, at), number);
    }
  }

  void meet(const std::string& prefix, const Numbers& mine, const std::string& id) {
    const auto others = distributed_.find(prefix);
    if (others == distributed_.end()) return;
    for (const Numbers& other : others->second) {
      if (mine.first <= other.last && other.first <= mine.last) return clash(id, mine.line, other.line);
    }
  }

  void meet_longer(const std::string& shorter, std::int64_t head, const Numbers& numbers) {
    if (head == 0) return;
    std::int64_t low = 0;  // of the numbers with this many digits
    for (std::int64_t power = 10; power <= 1'000'000'000'000'000'000 / 10 && head <= 900'000'000'000'000'000 / power;
         power *= 10) {
      const std::int64_t first = std::max(numbers.first, low);
      const std::int64_t last = std::min(numbers.last, power - 1);
      if (first <= last)
        meet(shorter, {head * power + first, head * power + last, numbers.line},
             shorter + std::to_string(head) + std::to_string(first));
      low = power;
    }
  }

  void clash(const std::string& id, int line, int other_line) {
    Element at;
    at.file = reading_.out().file;
    at.line = std::max(line, other_line);
    reading_.error(at,
                   "the id '" + id + "' is taken twice: also on line " + std::to_string(std::min(line, other_line)));
  }

  Reading& reading_;
  std::map<std::string, int> single_;
  std::map<std::string, std::vector<Numbers>> distributed_;
};

}  // namespace

void check_ids(Reading& reading) {
  Claims claims(reading);
  for (const RobotItem& item : reading.out().robots) claims.add(item.id, item.distribute, item.line);
  for (const ObjectItem& item : reading.out().objects) claims.add(item.id, item.distribute, item.line);
  for (const LightItem& item : reading.out().lights) claims.add(item.id, item.distribute, item.line);
  for (const SoundItem& item : reading.out().sounds) claims.add(item.id, std::nullopt, item.line);
  claims.check();
}

}  // namespace tandem::core
