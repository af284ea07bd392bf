/* SPDX-License-Identifier: BSD-3-Clause */
/* The functions in the table of measures. Each value is NAN where it cannot be measured. */
#ifndef MPS_CASE_VALUES_H
#define MPS_CASE_VALUES_H

#include "measure.h"

/* Allocate what the values need. @return MPS_E_NOMEM */
mps_status mps__open_front(quantity *q, mps_sim *sim);
mps_status mps__open_interface(quantity *q, mps_sim *sim);
mps_status mps__open_cavities(quantity *q, mps_sim *sim);

double mps__measure_front(quantity *q, mps_sim *sim);
double mps__measure_centre(quantity *q, mps_sim *sim);
double mps__measure_speed(quantity *q, mps_sim *sim);
double mps__measure_half_axis(quantity *q, mps_sim *sim);
double mps__measure_mass_centre(quantity *q, mps_sim *sim);
double mps__measure_top(quantity *q, mps_sim *sim);
double mps__measure_bottom(quantity *q, mps_sim *sim);
double mps__measure_circularity(quantity *q, mps_sim *sim);
double mps__measure_cavities(quantity *q, mps_sim *sim);
double mps__measure_pockets(quantity *q, mps_sim *sim);
double mps__measure_pocket_volume(quantity *q, mps_sim *sim);
double mps__measure_pocket_pressure(quantity *q, mps_sim *sim);
double mps__measure_gas_work(quantity *q, mps_sim *sim);
double mps__measure_jump(quantity *q, mps_sim *sim);
double mps__measure_gap(quantity *q, mps_sim *sim);
double mps__measure_angle(quantity *q, mps_sim *sim);
double mps__measure_strays(quantity *q, mps_sim *sim);
double mps__measure_trespass(quantity *q, mps_sim *sim);

#endif
