"""Submits the tasks of a job file of HyperQueue through its Python interface, to a server and a worker in this process."""
import sys
import tomllib

from hyperqueue import Job
from hyperqueue.cluster import LocalCluster, WorkerConfig

with open(sys.argv[1], "rb") as file:
    description = tomllib.load(file)
with LocalCluster() as cluster:
    cluster.start_worker(WorkerConfig(cores=2))
    client = cluster.client()
    job = Job(max_fails=description["max_fails"])
    for task in description["task"]:
        job.program(task["command"], stdout=task["stdout"], stderr=task["stderr"])
    client.wait_for_jobs([client.submit(job)])
