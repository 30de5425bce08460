#include "windlass/chain/strands.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "windlass/chain/topology.hpp"

namespace windlass::chain {

Strands::Strands(const Topology& topology) {
  const int joints = static_cast<int>(topology.stretches.size()) + 1;
  partner_.assign(joints, -1);
  line_of_.assign(joints, -1);
  mirrored_.assign(joints, false);
  facing_.resize(joints - 1);
  for (int j = 0; j < joints; ++j) shares_.push_back(topology.seat(j).shares);
  std::map<int, int> by_strand;
  std::vector<int> touches;
  for (int j = 0; j < joints; ++j) {
    const int strand = topology.seat(j).strand;
    if (strand == 0) continue;
    touches.push_back(j);
    const auto [found, fresh] = by_strand.try_emplace(std::abs(strand), j);
    if (fresh) continue;
    partner_[j] = found->second, partner_[found->second] = j;
    mirrored_[j] = mirrored_[found->second] = strand != topology.seat(found->second).strand;
  }
  for (const int j : touches)
    if (partner_[j] < 0) partner_[j] = j, mirrored_[j] = true;
  find_lines(topology);
  find_lines_on_obstacles(topology, touches);
  find_laid();
  face(touches);
}

bool Strands::pressed(int joint) const {
  if (joint < 0 || shares_[joint] == 0) return false;
  int at = joint;
  while (shares_[at] != 0) at += shares_[at];
  return !inside_line(at);
}

int Strands::others(int begin, int end, bool touches) const {
  int count = 0;
  for (int j = std::min(begin, end) + 1; j < std::max(begin, end); ++j)
    count += !inside_line(j) && (!touches || partner_[j] >= 0);
  return count;
}

bool Strands::divides_first(const StrandLine& line) const {
  const auto count = [&](const std::vector<int>& strand) {
    const auto [low, high] = std::minmax(strand.front(), strand.back());
    int sum = others(low, high);
    for (const StrandLine& other : lines_) {  // those that run along it
      if (&other == &line || other.own_image() || other.on_obstacles) continue;
      for (const std::vector<int>* side : {&other.first, &other.second}) {
        const auto [begin, end] = std::minmax(side->front(), side->back());
        sum += begin < high && end > low;
      }
    }
    return sum;
  };
  const int of_first = count(line.first), of_second = count(line.second);
  return of_first > of_second || (of_first == of_second && line.first.front() < line.second.front());
}

void Strands::find_laid() {
  laid_.assign(partner_.size(), false);
  for (const StrandLine& line : lines_) {
    const int links = line.links(), low = links / 2, high = links - low;
    const std::vector<int>&first = line.first, &second = line.second;
    const auto more = [&](bool touches) {
      return others(first.front(), first[low], touches) - others(first[high], first.back(), touches);
    };
    const bool by_first =
        line.own_image() ? more(false) > 0 || (more(false) == 0 && more(true) >= 0) : divides_first(line);
    for (int i = 1; i < links; ++i) {
      if (line.own_image() && 2 * i >= links) break;
      laid_[by_first ? first[i] : second[i]] = true;
    }
  }
}

std::array<int, 2> Strands::located_about(int before, int after) const {
  while (!located(before)) --before;
  while (!located(after)) ++after;
  return {before, after};
}

/// Lines that are marked as such (Seat::line): the second strand with the opposite number, unless it is the image of the first.
void Strands::find_lines(const Topology& topology) {
  std::map<int, StrandLine> marked;
  for (int j = 0; j < static_cast<int>(partner_.size()); ++j)
    if (const int line = topology.seat(j).line; line > 0 && partner_[j] >= 0)
      marked[line].first.push_back(j), marked[line].second.push_back(partner_[j]);
  for (auto& [number, line] : marked) {
    if (line.links() < 1) continue;
    line.image = mirrored_[line.first.front()];
    for (const int j : line.first) line_of_[j] = static_cast<int>(lines_.size());
    for (const int j : line.second) line_of_[j] = static_cast<int>(lines_.size());
    lines_.push_back(line);
  }
}

/// Touches next to each other on two strands that lie on obstacles are a line without a mark.
void Strands::find_lines_on_obstacles(const Topology& topology, const std::vector<int>& touches) {
  const auto follows = [&](int j) {  // the link after j faces one of the other strand, both on obstacles
    if (std::find(touches.begin(), touches.end(), j + 1) == touches.end()) return false;
    const int a = partner_[j], b = partner_[j + 1];
    return line_of_[j] < 0 && line_of_[j + 1] < 0 && mirrored_[j] == mirrored_[j + 1] &&
           b == a + (mirrored_[j] ? -1 : 1) && topology.stretches[j] == Stretch::line &&
           topology.stretches[std::min(a, b)] == Stretch::line;
  };
  for (const int start : touches) {
    if (line_of_[start] >= 0 || !follows(start)) continue;
    StrandLine line;
    line.image = mirrored_[start], line.on_obstacles = true;
    int j = start;
    line.first.push_back(j);
    while (follows(j)) line.first.push_back(++j);
    for (const int joint : line.first) line.second.push_back(partner_[joint]);
    for (const int joint : line.first) line_of_[joint] = static_cast<int>(lines_.size());
    for (const int joint : line.second) line_of_[joint] = static_cast<int>(lines_.size());
    lines_.push_back(line);
  }
}

void Strands::add(const Facing& f) {
  for (int link = f.begin; link < f.end; ++link) facing_[link].push_back(f);
  if (f.begin == f.other_begin) return;
  for (int link = f.other_begin; link < f.other_end; ++link)
    facing_[link].push_back({f.other_begin, f.other_end, f.begin, f.end, f.image, f.line});
}

void Strands::face(const std::vector<int>& touches) {
  for (int l = 0; l < static_cast<int>(lines_.size()); ++l) {
    const StrandLine& line = lines_[l];
    for (int i = 0; i < line.links(); ++i) {
      const auto [low, high] = std::minmax({line.second[i], line.second[i + 1]});
      if (!line.own_image() || line.first[i] <= low)
        add({line.first[i], line.first[i + 1], low, high, line.image, l});
    }
  }
  // Touches that are next to each other on either strand, and not both of one line; those with other strands do not count.
  const auto within = [](int joint, int one, int other) {
    return joint > std::min(one, other) && joint < std::max(one, other);
  };
  for (std::size_t k = 0; k + 1 < touches.size(); ++k) {
    const int j = touches[k], a = partner_[j];
    const auto follows =
        std::find_if(touches.begin() + static_cast<std::ptrdiff_t>(k) + 1, touches.end(), [&](int next) {
          return mirrored_[next] == mirrored_[j] && (mirrored_[j] ? partner_[next] < a : partner_[next] > a);
        });
    if (follows == touches.end()) continue;
    const int next = *follows, b = partner_[next];
    // Of a line that has opened about its middle what is between the two halves is none of it.
    const bool middle = a == next && line_of_[j] >= 0 && !lines_[line_of_[j]].own_image();
    if (line_of_[j] >= 0 && line_of_[j] == line_of_[next] && !middle) continue;
    if (std::min(a, b) < j) continue;  // found from the other strand
    const bool parted = std::any_of(touches.begin(), touches.end(),
                                    [&](int t) { return within(t, j, next) && within(partner_[t], a, b); });
    if (!parted) add({j, next, std::min(a, b), std::max(a, b), mirrored_[j], -1});
  }
}

bool Strands::inside_line(int joint) const {
  if (joint < 0 || line_of_[joint] < 0) return false;
  const StrandLine& line = lines_[line_of_[joint]];
  return joint != line.first.front() && joint != line.first.back() && joint != line.second.front() &&
         joint != line.second.back();
}

std::array<int, 2> Strands::neighbours(int joint) const {
  const StrandLine& line = lines_[line_of_[joint]];
  for (const std::vector<int>* side : {&line.first, &line.second}) {
    const auto found = std::find(side->begin(), side->end(), joint);
    if (found == side->end()) continue;
    const int before = *(found - 1), after = *(found + 1);
    return {std::min(before, after), std::max(before, after)};
  }
  return {joint, joint};
}

const Strands::Facing* Strands::facing(int link, int other, bool image) const {
  for (const Facing& f : facing_[link])
    if (f.image == image && other >= f.other_begin && other < f.other_end) return &f;
  return nullptr;
}

int Strands::line_along(int link) const {
  for (const Facing& f : facing_[link])
    if (f.line >= 0) return f.line;
  return -1;
}

bool Strands::along(int link) const { return line_along(link) >= 0; }

}  // namespace windlass::chain
