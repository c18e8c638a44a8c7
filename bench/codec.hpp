// Throughput of the foot-bot's codec and its two framings, in messages a second.
#pragma once

namespace tandem::bench {

/// Prints one JSON object a line: `repeat` rounds of each case.
void bench_codec(long long repeat);

}  // namespace tandem::bench
