"""Closed forms the benchmarks are checked against, by elliptic integrals."""
import math


def carlson_rf(x, y, z):
    """R_F(x, y, z) by duplication (Carlson 1979)."""
    while True:
        root = math.sqrt(x * y) + math.sqrt(y * z) + math.sqrt(z * x)
        mean = (x + y + z) / 3.0
        a, b = 1.0 - x / mean, 1.0 - y / mean
        c = -a - b
        if max(abs(a), abs(b), abs(c)) < 1e-3:
            e2, e3 = a * b - c * c, a * b * c
            return (1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0) / math.sqrt(mean)
        x, y, z = (x + root) / 4.0, (y + root) / 4.0, (z + root) / 4.0


def bisect(function, low, high):
    """Zero of a function that falls from low to high, to the last bit."""
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if function(middle) > 0.0 else (low, middle)
    return low


def coil_contact_force(T, phi, half_length):
    """R_tot of the flat coil with line contact and moment-free tails of finite length.

    With psi_e at the free end, T cos psi_e = T cos psi_0 + 1/2 (the Hamiltonian; the edge has the circle's curvature), and
    the tail is as long as  int_{psi_e}^{psi_0} dpsi / sqrt(2 T (cos psi_e - cos psi)) = F(theta, k) / sqrt(T),
    k = cos(psi_e/2). Unknown: log(1 - cos psi_e), which may be -50.
    """

    def edge(log_end):
        return math.acos(1.0 - math.exp(log_end) - 0.5 / T)

    def excess(log_end):
        end, psi = math.exp(log_end), edge(log_end)
        k2, complement = 1.0 - end / 2.0, end / 2.0
        cos2 = 0.25 / (T * k2)  # of the amplitude whose sine is cos(psi/2)/k
        scale = 0.5 * (end + 0.5 / T)
        sine = math.sqrt(cos2 / scale)
        length = sine * carlson_rf(complement * (1.0 - cos2) / scale, complement / scale, 1.0) / math.sqrt(T)
        return length - (half_length - 0.5 * phi + psi)

    psi = edge(bisect(excess, -600.0, math.log(0.5)))
    return 2.0 * T * ((0.5 * phi - psi) * math.cos(psi) + math.sin(psi))


def clamped_thrust(shortening):
    """End force of the planar clamped strut of unit length: d = 2 (1 - E/K), P = (4 K)^2, by the
    arithmetic-geometric mean."""

    def mean(k2):
        a, b, c2, total, weight = 1.0, math.sqrt(1.0 - k2), k2, 0.5 * k2, 1.0
        for _ in range(8):  # converges quadratically
            a, b, c2 = 0.5 * (a + b), math.sqrt(a * b), (0.5 * (a - b)) ** 2
            total += weight * c2
            weight *= 2.0
        return a, total

    k2 = bisect(lambda m: shortening - 2.0 * mean(m)[1], 0.0, 1.0 - 1e-12)
    return (2.0 * math.pi / mean(k2)[0]) ** 2
