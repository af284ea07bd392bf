/* SPDX-License-Identifier: BSD-3-Clause */
/* Folders of runs: invalid folders, the advice in messages, and files that --overwrite removes. */
#include "job_fixture.h"
#include "folder.h"
#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <time.h>

static void write_file(const char *path)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_int_equal(fclose(file), 0);
}

static void no_folders(void **state)
{
    char name[700];
    mps_job_config c = config_of("file");
    (void)state;
    write_file("file");
    refused(&c, MPS_E_IO, "--out file: Not a directory; must be a folder that can be written");
    c.folder = "file/below";
    refused(&c, MPS_E_IO, "--out file/below: Not a directory");
    memset(name, 'a', sizeof name - 1);
    name[sizeof name - 1] = '\0';
    c.folder = name;
    refused(&c, MPS_E_IO, "File name too long");
    c.folder = "/proc/self/run"; /* which takes no folders from anyone */
    refused(&c, MPS_E_IO, "--out /proc/self/run: ");
}

static void advice(void **state)
{
    static const struct {
        int error;
        const char *words;
    } all[] = {{EACCES, "change the permissions of this one"},
               {EPERM, "change the permissions"},
               {EROFS, "the disk can only be read"},
               {ENOSPC, "the disk is full"},
               {EDQUOT, "the disk is full"},
               {EIO, "must be a folder"}};
    (void)state;
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        const char *text = mps__folder_advice(all[k].error);
        if (!strstr(text, all[k].words)) fail_msg("%s: %s", strerror(all[k].error), text);
    }
}

static void open_folder(folder *f, const char *name)
{
    char error[1000] = "";
    if (mps__folder_open(f, name, true, error, sizeof error) != MPS_OK) fail_msg("%s", error);
}

/* Files of a run go, of one rank and of many; files with other names stay. */
static void removed(void **state)
{
    static const char *const goes[] = {"run/probes.csv",
                                       "run/case.yaml",
                                       "run/picture_1.png",
                                       "run/picture_0012.png",
                                       "run/frames/frames_000001.vtp",
                                       "run/frames/frames_000001_0003.vtp",
                                       "run/frames/frames_1234567_12345.vtp.tmp",
                                       "run/frames/frames_000002.pvtp",
                                       "run/frames/frames_000002.pvtp.tmp"},
                             *const stays[] = {"run/notes.txt",
                                               "run/picture_.png",
                                               "run/picture_1.jpg",
                                               "run/my_picture_1.png",
                                               "run/frames/frames_12345.vtp",
                                               "run/frames/frames_000001_3.vtp",
                                               "run/frames/frames_000001_0003x.vtp"};
    char error[1000] = "";
    folder f;
    (void)state;
    open_folder(&f, "run");
    assert_int_equal(mkdir("run/frames", 0777), 0);
    for (size_t k = 0; k < sizeof goes / sizeof *goes; k++) write_file(goes[k]);
    for (size_t k = 0; k < sizeof stays / sizeof *stays; k++) write_file(stays[k]);
    assert_true(mps__folder_clear(&f, NULL, error, sizeof error));
    for (size_t k = 0; k < sizeof goes / sizeof *goes; k++)
        if (is_there(".", goes[k])) fail_msg("%s is there", goes[k]);
    for (size_t k = 0; k < sizeof stays / sizeof *stays; k++)
        if (!is_there(".", stays[k])) fail_msg("%s is gone", stays[k]);
    mps__folder_close(&f);
    mps__folder_close(&f); /* a second time does nothing */
    assert_false(is_there("run", "run.lock"));
}

/* What cannot be removed is named, and ends it. */
static void not_removed(void **state)
{
    static const char *const names[] = {"held/steps.csv", "held/picture_3.png",
                                        "held/frames/frames_000004.vtp"};
    (void)state;
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        char error[1000] = "", wanted[100];
        folder f;
        open_folder(&f, "held");
        mkdir("held/frames", 0777);
        assert_int_equal(mkdir(names[k], 0777), 0);
        assert_false(mps__folder_clear(&f, NULL, error, sizeof error));
        snprintf(wanted, sizeof wanted, "--overwrite: cannot remove %s: Is a directory", names[k]);
        if (!strstr(error, wanted)) fail_msg("%s", error);
        assert_int_equal(rmdir(names[k]), 0);
        mps__folder_close(&f);
    }
}

/* The lock of a run on another machine, whose processes this system cannot query. */
static void write_lock(const char *path, const char *text, long age)
{
    const struct timespec times[2] = {{.tv_sec = time(NULL) - age}, {.tv_sec = time(NULL) - age}};
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
    assert_int_equal(utimensat(AT_FDCWD, path, times, 0), 0);
}

/* Another machine owns its lock as long as it renews it; a lock of this machine without a process
 * is stale. */
static void locks_of_machines(void **state)
{
    char host[200] = "", own[260], error[1000] = "";
    folder f;
    (void)state;
    assert_int_equal(mkdir("shared", 0777), 0);
    write_lock("shared/run.lock", "other-machine.invalid 4711\n", 30);
    assert_int_equal(mps__folder_open(&f, "shared", true, error, sizeof error), MPS_E_BUSY);
    if (!strstr(error, "process 4711 on other-machine.invalid")) fail_msg("%s", error);
    assert_true(is_there("shared", "run.lock"));
    write_lock("shared/run.lock", "other-machine.invalid 4711\n", 3600);
    open_folder(&f, "shared");
    assert_int_equal(gethostname(host, sizeof host - 1), 0);
    snprintf(own, sizeof own, "%s %ld\n", host, (long)getpid());
    assert_string_equal(text_of("shared", "run.lock"), own);
    /* a run renews it */
    write_lock("shared/run.lock", own, 3600);
    mps__folder_renew(&f);
    struct stat s;
    assert_int_equal(stat("shared/run.lock", &s), 0);
    assert_true(difftime(time(NULL), s.st_mtime) < 600);
    mps__folder_close(&f);
    snprintf(own, sizeof own, "%s 1\n", host);
    write_lock("shared/run.lock", own, 1);
    open_folder(&f, "shared");
    mps__folder_close(&f);
    write_lock("shared/run.lock", "", 1); /* of an earlier version */
    open_folder(&f, "shared");
    mps__folder_close(&f);
}

/* Nothing behind a link is removed or written. */
static void links_are_refused(void **state)
{
    char error[1000] = "";
    folder f;
    (void)state;
    assert_int_equal(mkdir("kept", 0777), 0);
    write_file("kept/frames_000001.vtp");
    write_file("kept/precious");
    open_folder(&f, "linked");
    assert_int_equal(symlink("../kept", "linked/frames"), 0);
    write_file("linked/probes.csv");
    assert_false(mps__folder_clear(&f, NULL, error, sizeof error));
    if (!strstr(error, "linked/frames is a link")) fail_msg("%s", error);
    assert_true(is_there("kept", "frames_000001.vtp") && is_there("linked", "probes.csv"));
    assert_false(mps__folder_has_no_links(&f, error, sizeof error));
    assert_int_equal(unlink("linked/frames"), 0);
    assert_true(mps__folder_has_no_links(&f, error, sizeof error));
    static const char *const names[] = {"linked/summary.json", "linked/picture_2.png",
                                        "linked/steps.csv"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        assert_int_equal(symlink("../kept/precious", names[k]), 0);
        assert_false(mps__folder_has_no_links(&f, error, sizeof error));
        if (!strstr(error, names[k])) fail_msg("%s", error);
        assert_true(mps__folder_clear(&f, NULL, error, sizeof error)); /* the link itself */
        assert_false(is_there(".", names[k]));
    }
    assert_true(is_there("kept", "precious"));
    mps__folder_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(locks_of_machines), cmocka_unit_test(links_are_refused),
        cmocka_unit_test(no_folders),        cmocka_unit_test(advice),
        cmocka_unit_test(removed),           cmocka_unit_test(not_removed)};
    return cmocka_run_group_tests(tests, enter_folder, leave_folder);
}
