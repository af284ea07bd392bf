/* SPDX-License-Identifier: BSD-3-Clause */
/* Trapped gas: what the files of the model gas.pocket share. */
#ifndef MPS_PHASE_GAS_POCKET_H
#define MPS_PHASE_GAS_POCKET_H

#include "helpers.h"
#include <mps/voids.h>
#include <string.h>

enum { MPS__POCKET_AMBIENT, MPS__POCKET_EXPONENT, MPS__POCKET_LEAST, MPS__POCKET_ULLAGE };

/* A pocket: members of type double only, as it stands in the state of the model. */
typedef struct mps__pocket {
    double gas;      /* amount: volume that it has at ambient pressure [m3, m2 in 2-D]; 0: none */
    double volume;   /* [m3, m2 in 2-D] */
    double pressure; /* above ambient [Pa] */
    double rate;     /* bound of its own angular frequency [rad/s] */
    double number;   /* from 1, in the order of closing */
    double since;    /* time of its closing [s] */
    double place;    /* component of the last raster */
    double flux;     /* into fluid particles, at the end of the last step [m3/s] */
} mps__pocket;

/* Of head and pockets: another number with each change of them. It is negative, because states
 * before it began with the number of pockets. */
#define MPS__POCKET_LAYOUT (-1.0)

/* What the state of the model begins with; then `pockets` of mps__pocket, then `runs` pairs. */
typedef struct mps__pocket_head {
    double layout;  /* MPS__POCKET_LAYOUT */
    double pockets; /* number */
    double serial;  /* pockets that have closed so far */
    double closed;  /* gas that has been enclosed so far */
    double vented;  /* gas that has gone so far: closed - vented is in the pockets */
    double dt;      /* length of the last step [s] */
    double work;    /* of the gas on the liquid in this step [J] */
    double open;    /* component that is the ambient, and its pressure [Pa] */
    double ambient;
    double flux;     /* of it into fluid particles, at the end of the last step [m3/s] */
    double cells[3]; /* of the last raster */
    double runs;     /* runs of equal labels in it: (length, label), labels MPS__POCKET_... */
    double moved;    /* how far the surface has moved since then, at most [m] */
    double waited;   /* steps since then */
} mps__pocket_head;

/* Labels of runs; pocket k has label MPS__POCKET_FIRST + k. */
enum { MPS__POCKET_NONE = 0, MPS__POCKET_OPEN = 1, MPS__POCKET_FIRST = 2 };

/* Pockets of the last step, as the state has them. */
typedef struct mps__pocket_old {
    const mps__pocket_head *head; /* NULL: there was none */
    const mps__pocket *pocket;
    const double *run;
} mps__pocket_old;

/* Components of the present step: what their pockets are made of. */
typedef struct mps__pocket_now {
    mps__pocket *pocket;    /* [count], by component; that of the ambient stays empty */
    int32_t open;           /* component that is the ambient */
    const double *geometry; /* [count] volume of each component by its cells and faces */
    int32_t *overlap; /* [count * (2 + old pockets)] zeroed: cells by label of the last step */
    double least;     /* cells that a void has at least when it closes */
    double ambient;   /* amount of gas in a volume of ambient [-] */
    double t;
} mps__pocket_now;

/* The first cell from one on that has another label, or `end`. Runs are long: 16 at once. */
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
/* Head and pockets of the state, to be changed. pocket: NULL, or out. @return NULL: no memory */
mps__pocket_head *mps__pocket_open(mps_stage *s, mps__pocket **pocket);
/* Keep head, pockets and labels for the next step. @return non-zero after a failure */
int mps__pocket_write(mps_stage *s, const mps_voids *voids, const mps__pocket_now *now,
                      mps__pocket_head *head);
/* mps_model_ops.check of gas.pocket. */
int mps__pocket_check(const double *numbers, int64_t count, char *why, size_t size);
/* Pressure of gas in a volume [Pa]. setting: of gas.pocket */
double mps__pocket_pressure(const double *setting, double gas, double volume);

/* Old and new pockets: who keeps, shares, joins and loses gas. gas_pocket_follow.c
 * head: changed: serial, closed, vented. */
void mps__pocket_follow(const mps_voids *voids, const mps__pocket_old *old, mps__pocket_now *now,
                        mps__pocket_head *head);

/* Channel "pocket_pressure": pressure of the gas before a particle; number of its faces, 0: no gas
 * is before it; 1: it belongs to a film between two voids. */
enum { MPS__ROW_PRESSURE, MPS__ROW_WEIGHT, MPS__ROW_FILM, MPS__POCKET_ROW };

/* Faces of components, sorted by the row of the particle behind them, and what loops over rows see.
 * gas_pocket_faces.c */
typedef struct mps__pocket_faces {
    mps_voids voids;
    double cover;                 /* [m] */
    const int32_t *begin;         /* [n+1] */
    const int32_t *face;          /* [begin[n]] */
    const int32_t *region;        /* channel */
    const double *correction;     /* channel */
    const double *velocity;       /* channel; NULL: places */
    const double *pressure;       /* [count] of components */
    const mps__pocket *pocket;    /* [count] the same */
    double *row, *slope, *number; /* channels that are written */
    double row_volume;            /* of a particle, in areas of a face [m] */
    int32_t from;                 /* first component of a batch of sums */
    int32_t aside;                /* component whose flux is left out; -1: none */
} mps__pocket_faces;

/* Whether this step looks for no voids. While there is no pocket it is enough to look after the
 * surface has moved by a spacing. velocity, region: channels; waits: out
 * @return non-zero after a failure. gas_pocket_look.c */
int mps__pocket_wait(mps_stage *s, const double *velocity, const int32_t *region, bool *waits);
/* The voids of the step, without those that are less than half of the smallest pocket. They are
 * looked at cell by cell, on the host: on a GPU the rest of the verb runs there, and s->data has
 * other addresses from here on. @return non-zero after a failure */
int mps__pocket_look(mps_stage *s, mps__pocket_faces *f);
/* Square or cube of a side. */
double mps__pocket_power(double side, int32_t dim);

/* Sort the faces by row. @return non-zero after a failure */
int mps__pocket_sort(mps_stage *s, mps__pocket_faces *f);
/* Volumes of components [count] by cells and faces [m3]. */
void mps__pocket_volumes(mps_stage *s, mps__pocket_faces *f, double *volume);
/* Fluxes into the liquid [m3/s], [count]: all; without half cells at walls, that have no particle. */
void mps__pocket_fluxes(mps_stage *s, mps__pocket_faces *f, double *flux, double *fluid);
/* Area of the faces of components with liquid behind them [count]. */
void mps__pocket_areas(const mps__pocket_faces *f, double *area);
/* Pressures, slopes of films and pockets of the rows: channels of gas.pocket. */
void mps__pocket_press(mps_stage *s, const mps__pocket_faces *f);
/* No row has a pocket before it. */
void mps__pocket_clear(mps_stage *s, const mps__pocket_faces *f);

#endif
