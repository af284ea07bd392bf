/* SPDX-License-Identifier: BSD-3-Clause */
/* Trapped gas: common declarations of the files of model gas.pocket. */
#ifndef MPS_PHASE_GAS_POCKET_H
#define MPS_PHASE_GAS_POCKET_H

#include "helpers.h"
#include <mps/voids.h>
#include <string.h>

enum { MPS__POCKET_AMBIENT, MPS__POCKET_EXPONENT, MPS__POCKET_LEAST, MPS__POCKET_ULLAGE };

/* A pocket, with members of type double only, as stored in the state of the model. */
typedef struct mps__pocket {
    double gas;      /* amount: its volume at ambient pressure [m3, m2 in 2-D]; 0: none */
    double volume;   /* [m3, m2 in 2-D] */
    double pressure; /* above ambient [Pa] */
    double rate;     /* upper bound of its natural angular frequency [rad/s] */
    double number;   /* from 1, in the order of closing */
    double since;    /* time at which it closed [s] */
    double place;    /* component of the last raster */
    double flux;     /* into fluid particles, at the end of the last step [m3/s] */
} mps__pocket;

/* Layout of head and pockets; it changes with them. It is negative because earlier states began
 * with the number of pockets. */
#define MPS__POCKET_LAYOUT (-1.0)

/* Begin of the model's state; then `pockets` of mps__pocket, then `runs` pairs. */
typedef struct mps__pocket_head {
    double layout;  /* MPS__POCKET_LAYOUT */
    double pockets; /* number */
    double serial;  /* pockets closed so far */
    double closed;  /* gas enclosed so far */
    double vented;  /* gas vented so far: closed - vented is in the pockets */
    double dt;      /* length of the last step [s] */
    double work;    /* of the gas on the liquid in this step [J] */
    double open;    /* component of the ambient, and its pressure [Pa] */
    double ambient;
    double flux;     /* of the ambient into fluid particles, at the end of the last step [m3/s] */
    double cells[3]; /* of the last raster */
    double runs;   /* runs of equal labels in the raster: (length, label), labels MPS__POCKET_... */
    double moved;  /* largest displacement of the surface since then [m] */
    double waited; /* steps since then */
} mps__pocket_head;

/* Labels of runs; pocket k has label MPS__POCKET_FIRST + k. */
enum { MPS__POCKET_NONE = 0, MPS__POCKET_OPEN = 1, MPS__POCKET_FIRST = 2 };

/* Pockets of the last step, from the state. */
typedef struct mps__pocket_old {
    const mps__pocket_head *head; /* NULL: none */
    const mps__pocket *pocket;
    const double *run;
} mps__pocket_old;

/* Components of the present step, from which its pockets are made. */
typedef struct mps__pocket_now {
    mps__pocket *pocket;    /* [count], by component; not used for the ambient */
    int32_t open;           /* component of the ambient */
    const double *geometry; /* [count] volume of each component by its cells and faces */
    /* [count * (2 + old pockets)] zeroed: number of cells by label of the last step */
    int32_t *overlap;
    double least;   /* smallest number of cells of a void that closes */
    double ambient; /* amount of gas per volume of ambient [-] */
    double t;
} mps__pocket_now;

/* First cell from this one on with another label, or `end`. Runs are long: tests 16 cells at
 * once. */
static inline int64_t mps__pocket_run(const int32_t *label, int64_t cell, int64_t end)
{
    enum { PAIRS = 8 };
    const int32_t same = label[cell];
    const uint64_t both = (uint32_t)same * UINT64_C(0x100000001);
    for (uint64_t pair[PAIRS], differ = 0; end - cell >= 2 * PAIRS; cell += 2 * PAIRS) {
        memcpy(pair, label + cell, sizeof pair);
        for (int k = 0; k < PAIRS; k++) differ |= pair[k] ^ both;
        if (differ) break;
    }
    while (cell < end && label[cell] == same) cell++;
    return cell;
}

/* The pockets of the last step. */
mps__pocket_old mps__pocket_read(const mps_stage *s);
/* Head and pockets of the state, writable. pocket: NULL, or out. @return NULL: out of memory */
mps__pocket_head *mps__pocket_open(mps_stage *s, mps__pocket **pocket);
/* Store head, pockets and labels for the next step. @return non-zero after a failure */
int mps__pocket_write(mps_stage *s, const mps_voids *voids, const mps__pocket_now *now,
                      mps__pocket_head *head);
/* mps_model_ops.check of gas.pocket. */
int mps__pocket_check(const double *numbers, int64_t count, char *why, size_t size);
/* Pressure of gas in a volume [Pa]. setting: of gas.pocket */
double mps__pocket_pressure(const double *setting, double gas, double volume);

/* Distribute the gas of old pockets to new ones. gas_pocket_follow.c
 * head: changed: serial, closed, vented. */
void mps__pocket_follow(const mps_voids *voids, const mps__pocket_old *old, mps__pocket_now *now,
                        mps__pocket_head *head);

/* Channel "pocket_pressure": pressure of the gas in front of a particle; number of its faces, 0: no
 * gas in front of it; 1: it belongs to a film between two voids. */
enum { MPS__ROW_PRESSURE, MPS__ROW_WEIGHT, MPS__ROW_FILM, MPS__POCKET_ROW };

/* Faces of components, sorted by the row of the particle behind them; arguments of loops over rows.
 * gas_pocket_faces.c */
typedef struct mps__pocket_faces {
    mps_voids voids;
    double cover;                 /* [m] */
    const int32_t *begin;         /* [n+1] */
    const int32_t *face;          /* [begin[n]] */
    const int32_t *region;        /* channel */
    const double *correction;     /* channel */
    const double *velocity;       /* channel; NULL: positions */
    const double *pressure;       /* [count] of components */
    const mps__pocket *pocket;    /* [count] of components */
    double *row, *slope, *number; /* channels that are written */
    double row_volume;            /* volume of a particle over the area of a face [m] */
    int32_t from;                 /* first component of a batch of sums */
    int32_t aside;                /* component whose flux is omitted; -1: none */
} mps__pocket_faces;

/* Whether this step skips the search for voids. While there is no pocket, a search is only needed
 * after the surface has moved by a spacing. velocity, region: channels; waits: out
 * @return non-zero after a failure. gas_pocket_look.c */
int mps__pocket_wait(mps_stage *s, const double *velocity, const int32_t *region, bool *waits);
/* The voids of the step, except those smaller than half of the smallest pocket. The host evaluates
 * them cell by cell; on a GPU the rest of the verb runs there, and from here on s->data has other
 * addresses. @return non-zero after a failure */
int mps__pocket_look(mps_stage *s, mps__pocket_faces *f);
/* Square or cube of a side. */
double mps__pocket_power(double side, int32_t dim);

/* Sort the faces by row. @return non-zero after a failure */
int mps__pocket_sort(mps_stage *s, mps__pocket_faces *f);
/* Volumes of components [count] by cells and faces [m3]. */
void mps__pocket_volumes(mps_stage *s, mps__pocket_faces *f, double *volume);
/* Fluxes into the liquid [m3/s], [count]: all; without half cells at walls, which have no
 * particle. */
void mps__pocket_fluxes(mps_stage *s, mps__pocket_faces *f, double *flux, double *fluid);
/* Areas of the faces of components with liquid behind them [count]. */
void mps__pocket_areas(const mps__pocket_faces *f, double *area);
/* Pressures, slopes of films and pockets of the rows: channels of gas.pocket. */
void mps__pocket_press(mps_stage *s, const mps__pocket_faces *f);
/* Set all rows to no pocket in front of them. */
void mps__pocket_clear(mps_stage *s, const mps__pocket_faces *f);

#endif
