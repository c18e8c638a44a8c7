// A page of the documentation as a reader follows it: its files are written, its commands typed, in a clean folder.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tandem::pages {

namespace fs = std::filesystem;

/// README.md, CONTRIBUTING.md, the pages under docs, and those that stand beside the code that they explain; sorted.
std::vector<fs::path> documents();

/// From its path, such as "docs-hooks".
std::string name_of(const fs::path& page);

/// Code blocks that carry a file's name after their language, by that name.
std::map<std::string, std::string> named_blocks(const std::string& markdown);

/// One thing to type, or a mark: a comment in the page's source, before the block or paragraph that it is for.
struct Command {
  enum class Kind {
    File,    ///< written: a block with a file's name after its language; the name is the first line of `text`
    Typed,   ///< a block `sh`, a line after `$ ` in a block `text`, or `./tandem …` in a paragraph
    Left,    ///< typed, and left running until the page's end: <!-- keeps running -->, or <!-- beside: COMMAND -->
    NotRun,  ///< <!-- not run: REASON -->
    Astray,  ///< a command in a block that is not run
  };
  Kind kind = Kind::Typed;
  std::string text;
  int line = 0;     ///< of the page
  int seconds = 0;  ///< after which it gets Ctrl-C: 2, unless <!-- takes: 9 s --> says more
};

/// In the page's order, <!-- as: THIS is THAT --> applied. Paragraphs' commands with words that the reader fills in
/// (FILE, …), or of one word, are none.
std::vector<Command> commands_of(const std::string& markdown);

/// The page done in a clean folder, which looks like a fresh clone whose program is the one under test. What takes
/// longer than it may is ended by Ctrl-C; of what builds and tests the checkout it is only looked whether it names
/// targets and tests that exist.
class Page {
 public:
  explicit Page(const fs::path& file);
  /// Types everything; where something fails, once more with four times as long limits: the machine may be busy.
  void run();
  /// The commands that failed, a line each. Empty: all went well.
  std::string failed() const;
  /// All that was said.
  std::string log() const;
  /// The folder in which it was typed.
  const fs::path& folder() const { return folder_; }

 private:
  int type_all(int slower) const;

  fs::path file_, room_, folder_;
};

}  // namespace tandem::pages
