#include "hal/archive.hpp"

#include <deque>
#include <gtest/gtest.h>
#include <map>
#include <random>
#include <set>
#include <vector>

namespace tandem::hal {
namespace {

struct Item {
  std::string name;
  std::vector<double> values;
  void remember(Archive& a) { a(name, values); }
  bool operator==(const Item&) const = default;
};

struct Everything {
  int number = 0;
  std::vector<Item> items;
  std::deque<std::string> texts;
  std::map<std::string, int> counts;
  std::set<std::int64_t> ids;
  std::optional<std::string> maybe;
  std::variant<std::monostate, double, std::string> one;
  std::pair<std::string, bool> pair;
  std::mt19937_64 chance;
  void remember(Archive& a) { a(number, items, texts, counts, ids, maybe, one, pair, chance); }
  bool operator==(const Everything&) const = default;
};

Everything some() {
  Everything e{7, {{"a", {1.5}}, {"", {}}}, {"x"}, {{"k", 2}}, {3, 4}, "m", std::string("v"), {"p", true}, {}};
  e.chance.discard(3);
  return e;
}

std::string written(Everything what) {
  Archive archive;
  what.remember(archive);
  return archive.take();
}

TEST(Archive, ReadsWhatItWrote) {
  for (const Everything& what : {some(), Everything()}) {
    const std::string bytes = written(what);
    Everything read = some();
    Archive archive(bytes);
    read.remember(archive);
    EXPECT_TRUE(archive.at_end());
    EXPECT_EQ(read, what);
  }
}

TEST(Archive, BytesThatAreMissingAreNoticedAndNothingIsAllocatedForThem) {
  const std::string bytes = written(some());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    Everything read;
    Archive archive(std::string_view(bytes).substr(0, size));
    read.remember(archive);
    EXPECT_FALSE(archive.ok()) << size;
  }
  const std::string many(8, '\x7F');
  std::vector<double> numbers;
  Archive archive(many);
  archive(numbers);
  EXPECT_FALSE(archive.ok());
  EXPECT_TRUE(numbers.empty());
}

TEST(Archive, AByteThatIsNeitherTrueNorFalseIsRefused) {
  bool yes = true;
  Archive archive("\x02");
  archive(yes);
  EXPECT_FALSE(archive.ok());
  EXPECT_TRUE(yes);
}

TEST(Archive, BytesThatAreLeftAreNoticed) {
  const std::string bytes = written(some()) + "x";
  Everything read;
  Archive archive(bytes);
  read.remember(archive);
  EXPECT_TRUE(archive.ok());
  EXPECT_FALSE(archive.at_end());
}

}  // namespace
}  // namespace tandem::hal
