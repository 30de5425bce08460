#pragma once

#include <Eigen/Dense>
#include <vector>

/// A turn of the whole rod that costs nothing (Chain::expect_neutral_turn), in the dense block of a chain.
namespace windlass::chain {

/// What a neutral motion leaves of a pivot, as a part of the one in the middle: the error that Newton's method has left.
inline constexpr double nearly_zero = 1e-6;

/// Size of the entries in the middle: an arc that is singular by itself leaves one of 1e10.
double median(Eigen::VectorXd values);

/// Is a factorised matrix singular but for the error that Newton's method has left?
bool is_singular(const Eigen::PartialPivLU<Eigen::MatrixXd>& lu);

/// A matrix that a neutral turn v makes singular, made regular with v and the left null vector u: its solutions are those
/// of the singular system, without a part along v, so that Newton does not wander along it. Where it is no turn that makes
/// the matrix singular, the matrix as it is.
/// @param locations  rows of location conditions, −1: none
Eigen::MatrixXd without_turn(const Eigen::MatrixXd& singular, const std::vector<Eigen::Index>& locations);

/// Eigenvalues below zero of a symmetric matrix, without one that is zero up to rounding and belongs to the turn.
int negative_but_turn(const Eigen::MatrixXd& dense, const std::vector<Eigen::Index>& locations);

}  // namespace windlass::chain
