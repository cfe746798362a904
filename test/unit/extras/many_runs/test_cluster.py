"""Faults of a cluster for which Dask itself prints a traceback: no certificate for TLS, and a lost scheduler."""
import pytest

from rbx1_nav.extras.many_runs.cluster import connected, open_cluster
from rbx1_nav.node.config import ConfigError

dask = pytest.importorskip('dask')
distributed = pytest.importorskip('distributed')


@pytest.mark.parametrize('file', [None, '/none.pem'])
def test_no_certificate(file):
    with dask.config.set({'distributed.comm.tls.ca-file': file, 'distributed.comm.tls.client.cert': file}):
        with pytest.raises(ConfigError, match='and for tls:// a certificate'):
            with open_cluster('tls://127.0.0.1:1', None, None):
                pass


def test_a_lost_scheduler():
    client = distributed.Client(processes=False, n_workers=1, dashboard_address=None)
    client.close()
    with pytest.raises(ConnectionError, match='^the scheduler is disconnected$'):
        connected(client.get_executor().submit, abs, -1)
