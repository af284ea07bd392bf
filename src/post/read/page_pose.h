/* SPDX-License-Identifier: BSD-3-Clause */
/* Determines the pose of the tank from three of its wall particles. */
#ifndef MPS_POST_PAGE_POSE_H
#define MPS_POST_PAGE_POSE_H

#include "page_film.h"

/* Pose of the tank in the first frame; at rest if the summary does not have it, or if frames are in
 * the frame of the tank. */
void mps__pose_start(film *f);
/* Choose the three particles in the first frame, where the tank has the pose f->start: ids in
 * f->reference. */
void mps__pose_choose(film *f, const film_frame *s);
/* Pose in a frame. @return false: one of the three is missing */
bool mps__pose_find(const film *f, const film_frame *s, film_pose *out);

#endif
