#include "crossing_count.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace continuation {

CrossingCount count_between(const Sample& lo, const Sample& hi) {
  if (lo.index < 0 || hi.index < 0) {
    if (lo.determinant == 0 || hi.determinant == 0) return {-1, 0};
    // det J has the sign of det [J F_p; t] times that of dp/ds.
    const double a = lo.determinant * lo.tangent.p, b = hi.determinant * hi.tangent.p;
    const int odd = (a < 0.0) != (b < 0.0) ? 1 : 0;
    const int seen = lo.small && hi.small ? sign_changes(*lo.small, *hi.small) : 0;
    return {seen % 2 == odd ? std::max(seen, odd) : odd, 0};
  }
  const int real = hi.index - lo.index, pairs = (hi.complex_index - lo.complex_index) / 2;
  CrossingCount best{std::abs(real), pairs};
  int fewest = std::abs(real) + std::abs(pairs);
  for (int turned = -std::abs(pairs) - 1; turned <= std::abs(pairs) + 1; ++turned) {
    const CrossingCount count{std::abs(real + 2 * turned), pairs - turned};
    const int events = count.real + std::abs(count.hopf) + std::abs(turned);
    if (events < fewest) best = count, fewest = events;
  }
  return best;
}

}  // namespace continuation
