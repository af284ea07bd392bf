/* SPDX-License-Identifier: BSD-3-Clause */
/* Checkpoints and disk errors: the order of operations that write a file, and errors of fsync(),
 * rename() and of a full disk. */
#define _DEFAULT_SOURCE /* syscall() */
#include "tank_fixture.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

static char folder[] = "mps_disk_XXXXXX", calls[64];
static int file_error, folder_error, rename_error; /* 0: none */

/* These replace functions of the system in the library. */
int fsync(int fd)
{
    struct stat what;
    assert_int_equal(fstat(fd, &what), 0);
    strcat(calls, S_ISDIR(what.st_mode) ? "folder " : "file ");
    errno = S_ISDIR(what.st_mode) ? folder_error : file_error;
    return errno ? -1 : (int)syscall(SYS_fsync, fd);
}

int rename(const char *from, const char *to)
{
    strcat(calls, "rename ");
    errno = rename_error;
    return errno ? -1 : (int)syscall(SYS_renameat, AT_FDCWD, from, AT_FDCWD, to);
}

static int set_up(void **state)
{
    mps_sim *sim = new_sim(2, 0.1);
    add_tank(sim, 0.6, 0.5, 0);
    fill_depth(sim, 0.6, 0.2, 0);
    *state = sim;
    return mkdtemp(folder) ? 0 : -1;
}

static int tear_down(void **state)
{
    char command[64];
    mps_sim_destroy(*state);
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command);
}

static int reset(void **state)
{
    (void)state;
    calls[0] = 0;
    file_error = folder_error = rename_error = 0;
    return 0;
}

static const char *path_of(const char *name)
{
    static char path[64];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static void order_of_calls(void **state)
{
    ASSERT_OK(*state, mps_checkpoint_write(*state, path_of("a")));
    assert_string_equal(calls, "file rename folder ");
    calls[0] = 0;
    assert_int_equal(chdir(folder), 0);
    ASSERT_OK(*state, mps_checkpoint_write(*state, "b"));
    assert_int_equal(chdir(".."), 0);
    assert_string_equal(calls, "file rename folder ");
    ASSERT_OK(*state, mps_checkpoint_read(*state, path_of("b")));
}

/* The existing file remains, and there is no other file. */
static void keeps_the_old(mps_sim *sim, const char *text)
{
    const int file = file_error, folder_ = folder_error, name = rename_error;
    reset(NULL);
    ASSERT_OK(sim, mps_checkpoint_write(sim, path_of("a")));
    file_error = file, folder_error = folder_, rename_error = name;
    ASSERT_REFUSED(sim, mps_checkpoint_write(sim, path_of("a")), MPS_E_IO, text);
    assert_int_equal(access(path_of("a.tmp"), F_OK), -1);
    ASSERT_OK(sim, mps_checkpoint_read(sim, path_of("a")));
}

static void file_not_on_disk(void **state)
{
    file_error = EIO;
    keeps_the_old(*state, "a.tmp\": Input/output error");
}

static void no_new_name(void **state)
{
    rename_error = EACCES;
    keeps_the_old(*state, "a\": Permission denied");
}

static void folder_not_on_disk(void **state)
{
    folder_error = EIO;
    ASSERT_REFUSED(*state, mps_checkpoint_write(*state, path_of("c")), MPS_E_IO,
                   "cannot write the folder \"mps_disk_");
    ASSERT_OK(*state, mps_checkpoint_read(*state, path_of("c")));
    folder_error = EINVAL; /* a file system that has no such thing */
    ASSERT_OK(*state, mps_checkpoint_write(*state, path_of("c")));
}

static void full_disk(void **state)
{
    if (access("/dev/full", W_OK) != 0) skip();
    assert_int_equal(symlink("/dev/full", path_of("full.tmp")), 0);
    ASSERT_REFUSED(*state, mps_checkpoint_write(*state, path_of("full")), MPS_E_IO,
                   "full.tmp\": No space left on device");
    assert_int_equal(access(path_of("full"), F_OK), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(order_of_calls, reset),
        cmocka_unit_test_setup(file_not_on_disk, reset),
        cmocka_unit_test_setup(no_new_name, reset),
        cmocka_unit_test_setup(folder_not_on_disk, reset),
        cmocka_unit_test_setup(full_disk, reset),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
