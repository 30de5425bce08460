#pragma once

#include <Eigen/Dense>

#include "windlass/chain/block.hpp"

/// A turn of the whole rod that costs nothing (Chain::expect_neutral_turn), in the dense block of a chain.
namespace windlass::chain {

/// What a matrix may make of a motion that costs nothing, as a part of its entry in the middle: the error that Newton's
/// method has left.
inline constexpr double nearly_zero = 1e-6;

/// Size of the entries in the middle: an arc that is singular by itself leaves one of 1e10.
double median(Eigen::VectorXd values);
/// The same of the largest in each row.
double usual_size(const Block& dense);
/// A + by·d dᵀ.
void hold(Block& dense, const Eigen::VectorXd& d, double by);

}  // namespace windlass::chain
