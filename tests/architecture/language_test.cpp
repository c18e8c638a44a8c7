// Holds the English of documents, comments and messages to that of an engineer's manual: words that made riddles may
// become fewer, never more.
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>

#include "tests/checkout.hpp"

namespace tandem::architecture {
namespace {

namespace fs = std::filesystem;

/// A word, and how often it may stand in: README and pages, decisions, comments of headers, messages.
struct Riddle {
  const char* word;
  std::array<int, 4> most;
};

constexpr std::array<const char*, 4> kKinds = {"documents", "decisions", "comments of headers", "messages"};

// Lower a number when a text has been mended. Write "the hub stops the robot" instead of "who is told stops", a noun
// instead of "what …", "again" instead of "anew".
constexpr std::array kRiddles = {
    Riddle{"who", {10, 20, 80, 20}},   Riddle{"whoever", {2, 20, 14, 4}}, Riddle{"what", {50, 147, 1295, 240}},
    Riddle{"nobody", {3, 29, 14, 42}}, Riddle{"somebody", {3, 2, 5, 7}},  Riddle{"told", {5, 19, 130, 42}},
    Riddle{"anew", {3, 16, 8, 17}},    Riddle{"patience", {0, 0, 0, 0}},
};

/// One kind of text, with the places where each word stands.
using Places = std::array<std::array<std::string, kRiddles.size()>, kKinds.size()>;
using Counts = std::array<std::array<int, kRiddles.size()>, kKinds.size()>;

struct Findings {
  Counts counts{};
  Places places;
};

void count_words(const std::string& line, std::size_t kind, const std::string& place, Findings& found) {
  std::string word;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    const auto c = i < line.size() ? static_cast<unsigned char>(line[i]) : static_cast<unsigned char>(' ');
    if (std::isalnum(c) != 0 || c == '_') {
      word += static_cast<char>(std::tolower(c));
      continue;
    }
    for (std::size_t w = 0; w < kRiddles.size(); ++w) {
      if (word != kRiddles[w].word) continue;
      ++found.counts[kind][w];
      found.places[kind][w] += "  " + place + ": " + line + "\n";
    }
    word.clear();
  }
}

/// Without code: fenced blocks, and spans between backticks.
void count_page(const fs::path& file, std::size_t kind, Findings& found) {
  const std::string path = fs::relative(file, test::kSourceDir).string() + ":";
  std::ifstream in(file);
  bool fenced = false;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.find("```") != std::string::npos) fenced = !fenced;
    if (fenced) continue;
    std::string prose;
    bool code = false;
    for (const char c : line) {
      if (c == '`') code = !code;
      prose += code ? ' ' : c;
    }
    count_words(prose, kind, path + std::to_string(number), found);
  }
}

/// Comments of a header, and texts between quotes that have a space, line by line: raw strings and blocks of /* */
/// aside.
void count_source(const fs::path& file, Findings& found) {
  const std::string path = fs::relative(file, test::kSourceDir).string() + ":";
  const bool header = file.extension() == ".hpp";
  std::ifstream in(file);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const std::string place = path + std::to_string(number);
    std::string text;
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (!quoted && line.compare(i, 2, "//") == 0) {
        if (header) count_words(line.substr(i), 2, place, found);
        break;
      }
      if (line[i] == '\\' || line.compare(i, 3, "'\"'") == 0) {
        i += line[i] == '\\' ? 1 : 2;
      } else if (line[i] == '"') {
        if (quoted && text.find(' ') != std::string::npos) count_words(text, 3, place, found);
        text.clear();
        quoted = !quoted;
      } else if (quoted) {
        text += line[i];
      }
    }
  }
}

Findings read_all() {
  Findings found;
  const fs::path top = test::kSourceDir;
  count_page(top / "README.md", 0, found);
  for (const char* folder :
       {"docs", "app", "bench", "bridges", "compat", "controllers", "core", "hal", "hooks", "lab", "library", "linked",
        "mixed_reality", "python", "studies", "study", "tests", "validate", "window"}) {
    for (const auto& entry : fs::recursive_directory_iterator(top / folder)) {
      const fs::path& file = entry.path();
      const bool decision = file.parent_path().filename() == "decisions" && std::string(folder) == "docs";
      if (file.extension() == ".md") count_page(file, decision ? 1 : 0, found);
      if (std::string(folder) == "tests") continue;
      if (file.extension() == ".hpp" || file.extension() == ".cpp") count_source(file, found);
    }
  }
  return found;
}

const Findings& texts() {
  static const Findings found = read_all();
  return found;
}

TEST(Language, HasNoMoreRiddlesThanItHad) {
  const Findings& found = texts();
  for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
    for (std::size_t w = 0; w < kRiddles.size(); ++w) {
      EXPECT_LE(found.counts[kind][w], kRiddles[w].most[kind])
          << "\"" << kRiddles[w].word << "\" in " << kKinds[kind] << ":\n"
          << found.places[kind][w];
    }
  }
}

/// So that limits are lowered as texts are mended.
TEST(Language, HasLimitsThatAreNearToTheTexts) {
  const Findings& found = texts();
  for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
    for (std::size_t w = 0; w < kRiddles.size(); ++w) {
      EXPECT_GE(found.counts[kind][w] + 25, kRiddles[w].most[kind])
          << "\"" << kRiddles[w].word << "\" in " << kKinds[kind];
    }
  }
}

}  // namespace
}  // namespace tandem::architecture
