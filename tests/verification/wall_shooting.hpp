#pragma once

#include <Eigen/Core>

/// The oracle of the struts between walls: the planar elastica from one end, by Runge-Kutta-Fehlberg 7(8) in
/// long double.
namespace windlass::test {

struct WallEvent {
  double shortening, thrust;
};

/// What holds at an event besides contact with the wall at y = h, tangentially: of a half of the strut, L =
/// 1.
enum class WallEventKind { touch, line, buckling };

/// Shooting for (P, V, what is free at the end, length of the free part).
WallEvent event_at(WallEventKind kind, bool clamped, double h);

/// Eigenvalues, ascending, of the second variation in the plane of a clamped strut that lies on the wall
/// between two free parts: ∫ δθ'² + (n·d) δθ² ds over both, against ∫ δθ² ds, with δy = 0 where the line
/// begins and δx = 0 between the ends. Linear elements in δθ, whose eigenvalues are above the right ones by
/// the square of their size.
Eigen::VectorXd variations_beside_the_line(double thrust, double h, int elements);

}  // namespace windlass::test
