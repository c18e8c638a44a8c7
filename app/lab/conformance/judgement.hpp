// Judgements of `tandem plugin check` about a plug-in.
#pragma once
#include <string>
#include <vector>

namespace tandem::app {

enum class Verdict { Good, Fault, NotJudged };

struct Judgement {
  Verdict verdict = Verdict::Good;
  std::string part;   ///< "device 'sensor thermometer default'"
  std::string what;   ///< what was looked at: "checkpoints"
  std::string found;  ///< a sentence without its full stop
};

using Judgements = std::vector<Judgement>;

}  // namespace tandem::app
