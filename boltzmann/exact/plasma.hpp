// Waves in a plasma of Maxwellian streams by kinetic theory: Langmuir waves, Landau damping, two streams.
#pragma once

#include <complex>
#include <vector>

namespace boltzmann::exact {

/// The plasma dispersion function Z(z) = i sqrt(pi) exp(-z^2) erfc(-i z) (B. D. Fried, S. D. Conte, *The Plasma
/// Dispersion Function*, 1961), to 12 digits. Near the real axis (|Im z| <= 1) the real and the imaginary part have
/// these digits each, so that damping by exp(-z^2) is not lost in roundings.
std::complex<double> plasma_dispersion(std::complex<double> z);

/// A Maxwellian stream of electrons: its own plasma frequency, its thermal velocity sqrt(kT/m) and its drift along the
/// wave, in any consistent units.
struct PlasmaStream {
  double plasma_frequency, thermal_velocity, drift;
};

/// sqrt(4 pi C n q^2 / m) of particles with this number density, charge and mass, with the constant C of Coulomb's law
/// C q q / r (1 in Gaussian units, 1/(4 pi epsilon_0) in SI). Errors: a density, a mass or a constant that is not
/// positive, a charge that is not finite.
double plasma_frequency(double number_density, double charge, double mass, double coulomb_constant);

/// The dielectric function for waves exp(i k x - i omega t) among these streams: 1 + sum (wp / (k v))^2 (1 + zeta
/// Z(zeta)) with zeta = (omega - k drift) / (sqrt(2) k v); ions are at rest. Its zeros are the waves of the plasma.
/// Errors: a wave number or a thermal velocity that is not positive.
std::complex<double> dielectric(std::vector<PlasmaStream> const& streams, double wave_number,
                                std::complex<double> omega);

/// The zero of the dielectric function next to `guess`, by Newton's method: frequency + i growth. Errors: as above; no
/// zero is found within 100 steps.
std::complex<double> plasma_root(std::vector<PlasmaStream> const& streams, double wave_number,
                                 std::complex<double> guess);

/// A wave whose field is proportional to exp(growth t) cos(frequency t): damped if the growth is negative.
struct PlasmaWave {
  double frequency, growth;
};

/// The Langmuir wave of a Maxwellian plasma at rest, its least damped root: the frequency and Landau's damping
/// (L. D. Landau, J. Phys. USSR 10, 25, 1946), of the plasma frequency wp, the thermal velocity v = sqrt(kT/m) and the
/// wave number k. k v / wp is k times the Debye length. Errors: a number that is not positive; k v / wp below 0.001 or
/// above 30.
PlasmaWave langmuir(double plasma_frequency, double thermal_velocity, double wave_number);

/// The frequency of long Langmuir waves, sqrt(wp^2 + 3 k^2 v^2) (D. Bohm, E. P. Gross, Phys. Rev. 75, 1851, 1949): 0.5 %
/// below that of `langmuir` at k v / wp = 0.2, 7 % at 0.5. Errors: a plasma frequency that is not positive, a thermal
/// velocity or a wave number that is negative.
double bohm_gross(double plasma_frequency, double thermal_velocity, double wave_number);

/// The growth rate of a wave in two equal streams with the velocities +-drift, which have half of wp^2 each; 0 if the
/// streams are stable. Cold ones (thermal velocity 0): with a = k drift, gamma^2 = (wp/2) sqrt(wp^2 + 8 a^2) - a^2 -
/// wp^2/2, stable from a = wp on, fastest at a = sqrt(3/8) wp, with wp/sqrt(8) (C. K. Birdsall, A. B. Langdon, *Plasma
/// Physics via Computer Simulation*, section 5.6). Warm ones: the zero of the dielectric function on the imaginary
/// axis. Errors: a plasma frequency, drift or wave number that is not positive, a thermal velocity that is negative.
double two_stream_growth(double plasma_frequency, double drift, double thermal_velocity, double wave_number);

}  // namespace boltzmann::exact
